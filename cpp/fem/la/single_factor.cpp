#include "fem/la/single_factor.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "errors.hpp"
#include "fem/la/one_thread.hpp"
#include "interrupt.hpp"

// Of BLAS and LAPACK.
extern "C" {
void spotrf_(const char* uplo, const int* n, float* a, const int* lda, int* info);
void strsm_(const char* side, const char* uplo, const char* trans, const char* diagonal,
            const int* m, const int* n, const float* alpha, const float* a, const int* lda,
            float* b, const int* ldb);
void ssyrk_(const char* uplo, const char* trans, const int* n, const int* k, const float* alpha,
            const float* a, const int* lda, const float* beta, float* c, const int* ldc);
void sgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const float* alpha, const float* a, const int* lda, const float* b, const int* ldb,
            const float* beta, float* c, const int* ldc);
}

namespace codesign::fem {
namespace {

constexpr float kPlus = 1.0f, kMinus = -1.0f, kZero = 0.0f;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Lower triangle of a symmetric matrix on ascending equations, wherever it is kept.
struct Front {
  const int* rows;
  int size;
  const float* value;  // (size, size)
};

}  // namespace

// The work of the factorization. A supernode's front is its own columns, which become those of the
// factor, and its update of later ones: a triangle of the rows below, on a stack until the
// supernode that eliminates its first row takes it. A subtree's supernodes follow each other, so
// what a supernode takes is on top.
class SingleFactor::Elimination {
 public:
  Elimination(SingleFactor& factor, const NodePattern& pattern, const LowerMatrix& matrix,
              const std::vector<DenseBlock>& blocks)
      : factor_(factor),
        structure_(factor.structure_),
        matrix_(matrix),
        kept_from_(pattern.equations() - factor.left_),
        supernode_of_(structure_.supernode_of()),
        place_(at(pattern.equations())),
        taken_(at(structure_.count())) {
    for (const DenseBlock& block : blocks) hand_on(front_of(block));
    for (int s = 0; s < structure_.count() && factor_.eliminated(s) > 0; ++s) eliminate(s);
    for (int column = kept_from_; column < pattern.equations(); ++column) add_kept(column);
  }

 private:
  static Front front_of(const DenseBlock& block) {
    return {block.equations.data(), static_cast<int>(block.equations.size()), block.value.data()};
  }

  // To the supernode that eliminates the first row, or to the complement.
  void hand_on(const Front& front) {
    if (front.size == 0) return;
    if (front.rows[0] < kept_from_) {
      taken_[at(supernode_of_[at(front.rows[0])])].push_back(front);
      return;
    }
    for (int j = 0; j < front.size; ++j)
      for (int i = j; i < front.size; ++i)
        factor_.complement_(front.rows[i] - kept_from_, front.rows[j] - kept_from_) +=
            front.value[at(j) * at(front.size) + at(i)];
  }

  void add_kept(int column) {
    for (int p = matrix_.start[at(column)]; p < matrix_.start[at(column + 1)]; ++p)
      factor_.complement_(matrix_.row[at(p)] - kept_from_, column - kept_from_) +=
          static_cast<float>(matrix_.value[at(p)]);
  }

  void eliminate(int s) {
    const int height = structure_.height(s), width = factor_.eliminated(s), below = height - width;
    const int* rows = structure_.rows(s);
    for (int i = 0; i < height; ++i) place_[at(rows[i])] = i;
    float* columns = factor_.value_.data() + factor_.start_[at(s)];
    for (int j = 0; j < width; ++j) {
      float* to = columns + at(j) * at(height);
      for (int p = matrix_.start[at(rows[j])]; p < matrix_.start[at(rows[j] + 1)]; ++p)
        to[place_[at(matrix_.row[at(p)])]] = static_cast<float>(matrix_.value[at(p)]);
    }
    update_.assign(at(below) * at(below), 0.0f);
    for (const Front& front : taken_[at(s)]) take(front, columns, height, width);
    int info = 0;
    spotrf_("L", &width, columns, &height, &info);
    if (info != 0) throw SolverError("a pivot is not positive in single precision");
    drop_taken(s);
    if (below == 0) return;
    strsm_("R", "L", "T", "N", &below, &width, &kPlus, columns, &height, columns + width, &height);
    ssyrk_("L", "N", &below, &width, &kMinus, columns + width, &height, &kPlus, update_.data(),
           &below);
    if (rows[width] < kept_from_) stack_.push_back(std::move(update_));
    const float* update = rows[width] < kept_from_ ? stack_.back().data() : update_.data();
    hand_on({rows + width, below, update});
  }

  // Adds a front to the supernode whose rows have been placed.
  void take(const Front& front, float* columns, int height, int width) {
    const int below = height - width;
    for (int j = 0; j < front.size; ++j) {
      const float* from = front.value + at(j) * at(front.size);
      const int column = place_[at(front.rows[j])];
      float* to = column < width ? columns + at(column) * at(height)
                                 : update_.data() + at(column - width) * at(below) - width;
      for (int i = j; i < front.size; ++i) to[place_[at(front.rows[i])]] += from[i];
    }
  }

  void drop_taken(int s) {
    while (!stack_.empty() &&
           std::any_of(taken_[at(s)].begin(), taken_[at(s)].end(),
                       [&](const Front& front) { return front.value == stack_.back().data(); }))
      stack_.pop_back();
    taken_[at(s)].clear();
  }

  SingleFactor& factor_;
  const FactorStructure& structure_;
  const LowerMatrix& matrix_;
  int kept_from_;                          // first equation that is left
  std::vector<int> supernode_of_, place_;  // of equations
  std::vector<std::vector<Front>> taken_;  // by each supernode
  std::vector<std::vector<float>> stack_;  // updates that wait
  std::vector<float> update_;              // of the supernode at work
};

SingleFactor::SingleFactor(const NodePattern& pattern, const LowerMatrix& matrix, int left,
                           const std::vector<DenseBlock>& blocks)
    : structure_(factor_structure(pattern)),
      left_(left),
      complement_(Eigen::MatrixXf::Zero(left, left)) {
  check_interrupt();
  const OneThread guard;
  start_.push_back(0);
  for (int s = 0; s < structure_.count(); ++s)
    start_.push_back(start_.back() + at(structure_.height(s)) * at(eliminated(s)));
  value_.assign(start_.back(), 0.0f);
  Elimination(*this, pattern, matrix, blocks);
}

int SingleFactor::eliminated(int supernode) const {
  const int last = structure_.first.back() - left_;
  return std::clamp(last - structure_.first[at(supernode)], 0, structure_.width(supernode));
}

void SingleFactor::solve_lower(Eigen::MatrixXf& x) const {
  const OneThread guard;
  const int equations = static_cast<int>(x.rows()), columns = static_cast<int>(x.cols());
  Eigen::MatrixXf change(structure_.tallest(), columns);
  const int change_rows = static_cast<int>(change.rows());
  for (int s = 0; s < structure_.count() && eliminated(s) > 0; ++s) {
    const int height = structure_.height(s), width = eliminated(s), below = height - width;
    const float* factor = value_.data() + start_[at(s)];
    const int* rows = structure_.rows(s) + width;
    float* own = x.data() + structure_.first[at(s)];
    strsm_("L", "L", "N", "N", &width, &columns, &kPlus, factor, &height, own, &equations);
    if (below == 0) continue;
    sgemm_("N", "N", &below, &columns, &width, &kPlus, factor + width, &height, own, &equations,
           &kZero, change.data(), &change_rows);
    for (int k = 0; k < columns; ++k)
      for (int i = 0; i < below; ++i) x(rows[i], k) -= change(i, k);
  }
}

void SingleFactor::solve_upper(Eigen::MatrixXf& x) const {
  const OneThread guard;
  const int equations = static_cast<int>(x.rows()), columns = static_cast<int>(x.cols());
  Eigen::MatrixXf known(structure_.tallest(), columns);
  const int known_rows = static_cast<int>(known.rows());
  for (int s = structure_.count() - 1; s >= 0; --s) {
    const int height = structure_.height(s), width = eliminated(s), below = height - width;
    if (width == 0) continue;
    const float* factor = value_.data() + start_[at(s)];
    const int* rows = structure_.rows(s) + width;
    float* own = x.data() + structure_.first[at(s)];
    if (below > 0) {
      for (int k = 0; k < columns; ++k)
        for (int i = 0; i < below; ++i) known(i, k) = x(rows[i], k);
      sgemm_("T", "N", &width, &columns, &below, &kMinus, factor + width, &height, known.data(),
             &known_rows, &kPlus, own, &equations);
    }
    strsm_("L", "L", "T", "N", &width, &columns, &kPlus, factor, &height, own, &equations);
  }
}

double SingleFactor::bytes() const {
  return static_cast<double>(sizeof(float) * (value_.size() + at(left_) * at(left_)) +
                             sizeof(int) * structure_.row.size());
}

}  // namespace codesign::fem
