#pragma once

#include <cmath>
#include <cstring>

// Two doubles that go through the same operations, vectors and symmetric matrices of them: the
// arithmetic of two bodies at once. A vector type of GCC and Clang: SSE2 on x86-64, plain doubles
// where a machine has none, and the same results on both.
namespace codesign::dynamics {

using Lanes = double __attribute__((vector_size(16)));

// A number for each of both.
inline Lanes lanes(double first, double second) { return Lanes{first, second}; }

// A vector for each.
struct LaneVector {
  Lanes x, y, z;
};

// Arithmetic of both at once.
inline LaneVector operator+(const LaneVector& a, const LaneVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneVector operator-(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LaneVector operator*(const Lanes& f, const LaneVector& a) {
  return {f * a.x, f * a.y, f * a.z};
}
inline Lanes dot(const LaneVector& a, const LaneVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Of a general matrix: three columns or three rows, as its owner says.
struct LaneMatrix {
  LaneVector a, b, c;
};

// Columns times a vector.
inline LaneVector combine(const LaneMatrix& columns, const LaneVector& v) {
  return v.x * columns.a + v.y * columns.b + v.z * columns.c;
}

// A symmetric matrix for each.
struct LaneSymmetric {
  Lanes xx, xy, xz, yy, yz, zz;
  LaneVector column_x() const { return {xx, xy, xz}; }
  LaneVector column_y() const { return {xy, yy, yz}; }
  LaneVector column_z() const { return {xz, yz, zz}; }
};

// Sum for both.
inline LaneSymmetric operator+(const LaneSymmetric& a, const LaneSymmetric& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}

// Matrix times vector, for both.
inline LaneVector operator*(const LaneSymmetric& m, const LaneVector& v) {
  return {dot(m.column_x(), v), dot(m.column_y(), v), dot(m.column_z(), v)};
}

// m − v wᵀ, where it is symmetric.
inline LaneSymmetric less_product(const LaneSymmetric& m, const LaneVector& v,
                                  const LaneVector& w) {
  return {m.xx - v.x * w.x, m.xy - v.x * w.y, m.xz - v.x * w.z,
          m.yy - v.y * w.y, m.yz - v.y * w.z, m.zz - v.z * w.z};
}

// R m Rᵀ, R by its columns.
inline LaneSymmetric rotate(const LaneMatrix& R, const LaneSymmetric& m) {
  const LaneVector u = combine(R, m.column_x()), v = combine(R, m.column_y()),
                   w = combine(R, m.column_z());  // columns of R m
  const auto entry = [&](Lanes ux, Lanes vx, Lanes wx, Lanes rx, Lanes ry, Lanes rz) {
    return ux * rx + vx * ry + wx * rz;
  };
  return {entry(u.x, v.x, w.x, R.a.x, R.b.x, R.c.x), entry(u.x, v.x, w.x, R.a.y, R.b.y, R.c.y),
          entry(u.x, v.x, w.x, R.a.z, R.b.z, R.c.z), entry(u.y, v.y, w.y, R.a.y, R.b.y, R.c.y),
          entry(u.y, v.y, w.y, R.a.z, R.b.z, R.c.z), entry(u.z, v.z, w.z, R.a.z, R.b.z, R.c.z)};
}

// Hyperbolic tangent, exact to a few 1e-16 of one: (1 − t) / (1 + t) with t = exp(−2 |x|), whose
// exponent is split into powers of two and a rest with a Taylor polynomial. The same digits with
// every C library.
inline Lanes hyperbolic_tangent(const Lanes& x) {
  using Bits = long long __attribute__((vector_size(16)));
  constexpr double kRound = 0x1.8p52;
  constexpr double kHigh = 6.93147180369123816490e-01,
                   kLow = 1.90821492927058770002e-10;  // of ln 2
  constexpr double kAllOfIt = -45.0;                   // below, 1 + t is 1
  constexpr double kInverseFactorials[] = {1.0 / 6227020800.0,
                                           1.0 / 479001600.0,
                                           1.0 / 39916800.0,
                                           1.0 / 3628800.0,
                                           1.0 / 362880.0,
                                           1.0 / 40320.0,
                                           1.0 / 5040.0,
                                           1.0 / 720.0,
                                           1.0 / 120.0,
                                           1.0 / 24.0,
                                           1.0 / 6.0,
                                           1.0 / 2.0,
                                           1.0,
                                           1.0};
  Lanes y = x < 0.0 ? 2.0 * x : -2.0 * x;
  y = y < kAllOfIt ? lanes(kAllOfIt, kAllOfIt) : y;
  const Lanes shifted = y * 1.44269504088896338700 + kRound;  // its last bits are the power of two
  const Lanes power = shifted - kRound;
  const Lanes rest = (y - power * kHigh) - power * kLow;
  Lanes t = lanes(kInverseFactorials[0], kInverseFactorials[0]);
  for (int i = 1; i < 14; ++i) t = t * rest + kInverseFactorials[i];
  Bits bits, of_power;
  std::memcpy(&bits, &t, sizeof(bits));
  std::memcpy(&of_power, &shifted, sizeof(of_power));
  bits += of_power << 52;
  std::memcpy(&t, &bits, sizeof(t));
  const Lanes size = (1.0 - t) / (1.0 + t);
  return x < 0.0 ? -size : size;
}

// Sine and cosine to two units in the last place. Their own polynomials (minimax of degrees 13 and
// 14 on ±π/4, as in fdlibm) give the same digits with every C library.
inline void sine_cosine(const Lanes& angle, Lanes& sine, Lanes& cosine) {
  constexpr double kLargest = 1e5;  // π/2 in two parts is exact enough up to there
  if (!(std::abs(angle[0]) < kLargest && std::abs(angle[1]) < kLargest)) {
    sine = lanes(std::sin(angle[0]), std::sin(angle[1]));
    cosine = lanes(std::cos(angle[0]), std::cos(angle[1]));
    return;
  }
  using Bits = long long __attribute__((vector_size(16)));
  constexpr double kRound = 0x1.8p52;
  constexpr double kHigh = 1.57079632673412561417, kLow = 6.07710050650619224932e-11;  // of π/2
  const Lanes shifted = angle * 0.63661977236758134308 + kRound;  // quarter turns in its last bits
  const Lanes turns = shifted - kRound;
  const Lanes x = (angle - turns * kHigh) - turns * kLow;
  const Lanes z = x * x;
  Lanes s = 1.58969099521155010221e-10 * z - 2.50507602534068634195e-08;
  s = (s * z + 2.75573137070700676789e-06) * z - 1.98412698298579493134e-04;
  s = (s * z + 8.33333333332248946124e-03) * z - 1.66666666666666324348e-01;
  s = x + x * (z * s);
  Lanes c = -1.13596475577881948265e-11 * z + 2.08757232129817482790e-09;
  c = (c * z - 2.75573143513906633035e-07) * z + 2.48015872894767294178e-05;
  c = (c * z - 1.38888888888741095749e-03) * z + 4.16666666666666019037e-02;
  c = 1.0 - (0.5 * z - z * (z * c));
  Bits quarter, of_sine, of_cosine;
  std::memcpy(&quarter, &shifted, sizeof(quarter));
  std::memcpy(&of_sine, &s, sizeof(of_sine));
  std::memcpy(&of_cosine, &c, sizeof(of_cosine));
  const Bits odd = -(quarter & 1);  // all bits, or none: then sine and cosine change places
  const Bits along = (of_cosine & odd) | (of_sine & ~odd);
  const Bits across = (of_sine & odd) | (of_cosine & ~odd);
  const Bits sine_bits = along ^ ((quarter & 2) << 62);  // signs
  const Bits cosine_bits = across ^ (((quarter + 1) & 2) << 62);
  std::memcpy(&sine, &sine_bits, sizeof(sine));
  std::memcpy(&cosine, &cosine_bits, sizeof(cosine));
}

}  // namespace codesign::dynamics
