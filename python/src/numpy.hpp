// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "errors.hpp"
#include "papilla/core/values.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

/// Numbers of the library as arrays of numpy.
namespace papilla::python {

namespace py = pybind11;

/// How numpy sees a number. Indices are signed in Python, where -1 stands for none.
template <class T>
struct NumpyScalar {
  using type = T;
};
template <>
struct NumpyScalar<std::uint32_t> {
  using type = std::int32_t;
};
template <>
struct NumpyScalar<std::uint64_t> {
  using type = std::int64_t;
};
template <>
struct NumpyScalar<std::byte> {
  using type = std::uint8_t;
};

/// What a row of an array is made of: `k_columns` numbers, or one where that is 0.
template <class T>
struct RowTraits {
  using scalar = T;
  static constexpr std::size_t k_columns = 0;
};
template <>
struct RowTraits<Vec2> {
  using scalar = double;
  static constexpr std::size_t k_columns = 2;
};
template <>
struct RowTraits<Vec3> {
  using scalar = double;
  static constexpr std::size_t k_columns = 3;
};
template <>
struct RowTraits<Color> {
  using scalar = float;
  static constexpr std::size_t k_columns = 4;
};
template <class T, std::size_t N>
struct RowTraits<std::array<T, N>> {
  using scalar = typename RowTraits<T>::scalar;
  static constexpr std::size_t k_columns = N;
};
template <class T, std::size_t N>
struct RowTraits<T[N]> {
  using scalar = typename RowTraits<T>::scalar;
  static constexpr std::size_t k_columns = N;
};

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>;

/// Vec2, Vec3, colours and arrays of fixed size of numbers and these.
template <class T>
concept Row = RowTraits<T>::k_columns != 0 && Number<typename RowTraits<T>::scalar>;

/// The shape of one value.
template <class T>
std::vector<py::ssize_t> shape_of() {
  if constexpr (RowTraits<T>::k_columns == 0) {
    return {};
  } else {
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(RowTraits<T>::k_columns)};
    if constexpr (requires { typename T::value_type; })
      for (const py::ssize_t side : shape_of<typename T::value_type>()) shape.push_back(side);
    return shape;
  }
}

template <class T>
py::dtype dtype_of() {
  return py::dtype::of<typename NumpyScalar<typename RowTraits<T>::scalar>::type>();
}

/// `count` values from `data` on as an array that looks at them; `base` keeps them alive.
template <class T>
py::array view_of(const T* data, std::size_t count, py::handle base) {
  auto shape = shape_of<T>();
  shape.insert(shape.begin(), static_cast<py::ssize_t>(count));
  return py::array(dtype_of<T>(), std::move(shape), {}, data, base);
}

/// One row as an array that looks at it.
template <Row T>
py::array view_of_one(const T& row, py::handle base) {
  return py::array(dtype_of<T>(), shape_of<T>(), {}, &row, base);
}

/// An array that owns the vector, without a copy.
template <class T, class A>
py::array take(std::vector<T, A>&& values) {
  using Kept = std::vector<T, A>;
  auto kept = std::make_unique<Kept>(std::move(values));
  const T* data = kept->data();
  const std::size_t count = kept->size();
  const py::capsule owner(kept.get(), [](void* pointer) { delete static_cast<Kept*>(pointer); });
  static_cast<void>(kept.release());
  return view_of(data, count, owner);
}

/// An array of this type and of `shape`, of which -1 stands for any length: contiguous, aligned, and the given one
/// itself where that is so already. Lists become arrays; numbers are converted where they keep their value.
/// @throws UsageError naming `place`.
py::array array_of(py::handle value, const py::dtype& dtype, const std::vector<py::ssize_t>& shape,
                   const std::string& place);

/// One value a row.
template <class T>
py::array rows_of(py::handle value, const std::string& place) {
  auto shape = shape_of<T>();
  shape.insert(shape.begin(), -1);
  return array_of(value, dtype_of<T>(), shape, place);
}

/// Whether a struct may look into the memory of an array of array_of(): it may be written to and is not that of another
/// struct, as these are values of their own.
bool is_lendable(const py::array& array);

/// Holds the array as long as C++ looks into it; from any thread. What is left when Python ends goes with the process.
std::shared_ptr<void> keeper_of(py::array array);

/// The `count` values of an array of array_of(), looked at in place where that is lendable, else copied.
template <class T>
Values<T> values_in(const py::array& array, std::size_t count) {
  if (is_lendable(array))
    return borrowed_values(keeper_of(array), static_cast<T*>(const_cast<py::array&>(array).mutable_data()), count);
  Values<T> values(count);
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), array.data(), count * sizeof(T));
  return values;
}

template <class T>
void read_rows(py::handle value, Values<T>& values, const std::string& place) {
  const py::array array = rows_of<T>(value, place);
  values = values_in<T>(array, static_cast<std::size_t>(array.shape(0)));
}

/// A plain vector has memory of its own.
template <class T>
void read_rows(py::handle value, std::vector<T>& values, const std::string& place) {
  const py::array array = rows_of<T>(value, place);
  values.resize(static_cast<std::size_t>(array.shape(0)));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), array.data(), values.size() * sizeof(T));
}

/// An array that is only read, looked at in place.
template <class T>
class ReadRows {
 public:
  ReadRows(py::handle value, const std::string& place)
      : array_(rows_of<T>(value, place)),
        rows_(static_cast<const T*>(array_.data()), static_cast<std::size_t>(array_.shape(0))) {}
  std::span<const T>& get() { return rows_; }

 private:
  py::array array_;
  std::span<const T> rows_;
};

template <Row T>
void copy_row(py::handle value, T& row, const std::string& place) {
  const py::array array = array_of(value, dtype_of<T>(), shape_of<T>(), place);
  std::memcpy(static_cast<void*>(&row), array.data(), sizeof(T));
}

}  // namespace papilla::python

namespace pybind11::detail {

/// Vec2, Vec3 and colours inside of other containers: arrays that are copies.
template <class T>
struct row_caster {
  PYBIND11_TYPE_CASTER(T, const_name("numpy.ndarray"));
  bool load(handle source, bool) {
    papilla::python::copy_row(source, value, "argument");
    return true;
  }
  static handle cast(const T& row, return_value_policy, handle) {
    return papilla::python::view_of_one(row, handle()).release();
  }
};
template <>
struct type_caster<papilla::Vec2> : row_caster<papilla::Vec2> {};
template <>
struct type_caster<papilla::Vec3> : row_caster<papilla::Vec3> {};
template <>
struct type_caster<papilla::Color> : row_caster<papilla::Color> {};

}  // namespace pybind11::detail
