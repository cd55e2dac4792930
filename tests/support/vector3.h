/// @file
/// Three numbers of any kind, for the oracle: double, Quad or Wide.

#pragma once

#include <array>

namespace firstcontact::oracle {

/// Number of 113 bits; used only for estimates that Wide then proves.
__extension__ using Quad = __float128;

template <class T>
struct Vector3 {
  T x{}, y{}, z{};

  friend Vector3 operator+(const Vector3& a, const Vector3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vector3 operator-(const Vector3& a, const Vector3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vector3 operator*(const T& s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Matrix by its columns, such as those of a rotation.
template <class T>
struct Matrix3 {
  std::array<Vector3<T>, 3> column{};

  friend Vector3<T> operator*(const Matrix3& m, const Vector3<T>& v) {
    return v.x * m.column[0] + v.y * m.column[1] + v.z * m.column[2];
  }
};

}  // namespace firstcontact::oracle
