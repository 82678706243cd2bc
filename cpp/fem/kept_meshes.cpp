#include "fem/kept_meshes.hpp"

#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "fem/meshing/tet_mesher.hpp"

namespace codesign::fem {
namespace {

// Everything that decides a result, in its bytes.
class Key {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> Key& add(const T& value) { return add(&value, 1); }
  template <class Derived>
  Key& add(const Eigen::PlainObjectBase<Derived>& matrix) {
    add(matrix.rows());
    return add(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }
  template <class T>
  Key& add(const std::vector<T>& values) {
    add(values.size());
    return add(values.data(), values.size());
  }
  const std::string& bytes() const { return bytes_; }

  template <class T>
  Key& add(const T* values, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    return *this;
  }

 private:
  std::string bytes_;
};

std::string mesh_key(const SurfaceMesh& surface, const SizeField& size,
                     const MeshOptions& options) {
  Key key;
  key.add(surface.points).add(surface.triangles).add(surface.face);
  for (const std::string& name : surface.face_names)
    key.add(name.size()).add(name.data(), name.size());
  key.add(size.base);
  for (const SizeSource& source : size.sources)
    key.add(source.points).add(source.size).add(source.growth).add(source.radius);
  for (const auto& wall : size.walls) key.add(reinterpret_cast<std::size_t>(wall.get()));
  key.add(options.feature_angle).add(options.simplify).add(options.facet_distance);
  key.add(options.facet_angle).add(options.radius_edge).add(options.sliver_angle);
  key.add(options.flat_angle).add(options.curved).add(options.max_questions);
  key.add(options.max_vertices).add(options.check_intersections).add(options.topology_rounds);
  return key.bytes();
}

// With the limits: a factor that they do not allow is none, whatever others have kept.
std::string elements_key(const Stretch& stretch, const Material& material,
                         const Constraints& constraints, const FactorLimits& limits) {
  Key key;
  key.add(limits.memory).add(limits.operations);
  key.add(stretch.origin).add(stretch.direction).add(stretch.from).add(stretch.to);
  key.add(material.young_modulus).add(material.poisson_ratio).add(constraints.fixed);
  return key.bytes();
}

double mesh_bytes(const TetMesh& mesh) {
  return sizeof(double) * static_cast<double>(mesh.nodes.size()) +
         sizeof(int) * static_cast<double>(mesh.tets.size() + mesh.boundary.size());
}

// A factor with its worth: what it saves for each byte, in multiply-adds, above what the last
// forgotten one was worth when it went. So the dear and the lately used stay (GreedyDual-Size, Cao
// and Irani 1997).
struct Factor {
  std::string key;
  std::shared_ptr<const KeptElements> elements;
  double worth = 0.0;
};

struct Entry {
  std::string key;
  std::shared_ptr<const TetMesh> mesh;
  std::vector<std::shared_ptr<const SizePoints>> walls;  // alive, as the key has their addresses
  std::vector<Factor> factors = {};

  double bytes() const { return mesh_bytes(*mesh) + static_cast<double>(key.size()); }
};

struct Store {
  std::mutex mutex;
  double limit = 256e6;      // bytes
  double forgotten = 0.0;    // worth of the last forgotten factor
  std::list<Entry> entries;  // the last used first

  Entry* find(const std::string& key) {
    for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
      if (entry->key != key) continue;
      entries.splice(entries.begin(), entries, entry);
      return &entries.front();
    }
    return nullptr;
  }

  Entry* find(const TetMesh* mesh) {
    for (Entry& entry : entries)
      if (entry.mesh.get() == mesh) return &entry;
    return nullptr;
  }

  void use(Factor& factor) const {
    factor.worth = forgotten + factor.elements->operations() / factor.elements->bytes();
  }

  double bytes() const {
    double sum = 0.0;
    for (const Entry& entry : entries) {
      sum += entry.bytes();
      for (const Factor& factor : entry.factors) sum += factor.elements->bytes();
    }
    return sum;
  }

  // Whether there was a factor to forget.
  bool forget_least() {
    Entry* owner = nullptr;
    std::size_t least = 0;
    for (Entry& entry : entries)
      for (std::size_t i = 0; i < entry.factors.size(); ++i)
        if (!owner || entry.factors[i].worth < owner->factors[least].worth) {
          owner = &entry;
          least = i;
        }
    if (!owner) return false;
    forgotten = owner->factors[least].worth;
    owner->factors.erase(owner->factors.begin() + static_cast<std::ptrdiff_t>(least));
    return true;
  }

  void shrink() {
    while (bytes() > limit && forget_least()) {
    }
    while (bytes() > limit && entries.size() > 1) entries.pop_back();
  }
};

Store& store() {
  static Store instance;
  return instance;
}

}  // namespace

void limit_kept_meshes(double bytes) {
  const std::lock_guard<std::mutex> lock(store().mutex);
  store().limit = bytes;
  store().shrink();
}

bool forget_meshes() {
  const std::lock_guard<std::mutex> lock(store().mutex);
  const bool any = !store().entries.empty();
  store().entries.clear();
  return any;
}

std::shared_ptr<const TetMesh> kept_mesh(const SurfaceMesh& surface, const SizeField& size,
                                         const MeshOptions& options) {
  std::string key = mesh_key(surface, size, options);
  {
    const std::lock_guard<std::mutex> lock(store().mutex);
    if (const Entry* entry = store().find(key)) return entry->mesh;
  }
  auto mesh = std::make_shared<const TetMesh>(tetrahedralize(surface, size, options));
  const std::lock_guard<std::mutex> lock(store().mutex);
  if (const Entry* entry = store().find(key)) return entry->mesh;  // another thread was faster
  store().entries.push_front({std::move(key), mesh, size.walls});
  store().shrink();
  return mesh;
}

std::shared_ptr<const KeptElements> kept_elements(const std::shared_ptr<const TetMesh>& mesh,
                                                  const Stretch& stretch, const Material& material,
                                                  const Constraints& constraints,
                                                  const FactorLimits& limits) {
  const std::string key = elements_key(stretch, material, constraints, limits);
  {
    const std::lock_guard<std::mutex> lock(store().mutex);
    if (Entry* entry = store().find(mesh.get()))
      for (Factor& factor : entry->factors)
        if (factor.key == key) {
          store().use(factor);
          return factor.elements;
        }
  }
  std::shared_ptr<const KeptElements> elements;
  try {
    elements = keep_elements(*mesh, reshaped_tets(*mesh, stretch), material, constraints, limits);
  } catch (const MemoryLimitError&) {
    return nullptr;
  }
  const std::lock_guard<std::mutex> lock(store().mutex);
  if (Entry* entry = store().find(mesh.get())) {
    entry->factors.push_back({key, elements});
    store().use(entry->factors.back());
    store().shrink();
  }
  return elements;
}

}  // namespace codesign::fem
