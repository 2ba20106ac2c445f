// SPDX-License-Identifier: MIT
#pragma once

#include "function.hpp"

namespace papilla::python {

/// Texture coordinates as numpy has them: (n, 2) per position, (m, 3, 2) per corner, or indexed. None: empty.
class UvInput {
 public:
  UvInput(py::handle given, const std::string& place) : place_(place) {
    if (given.is_none()) return;
    if (py::isinstance<CornerAttribute<Vec2>>(given)) {
      kind_ = Kind::indexed;
      indexed_ = &given.cast<const CornerAttribute<Vec2>&>();
      return;
    }
    const py::object array = py::module_::import("numpy").attr("asarray")(given);
    if (array.attr("ndim").cast<int>() == 3) {
      kind_ = Kind::corners;
      const py::array corners = array_of(array, dtype_of<double>(), {-1, 3, 2}, place);
      values_ = values_in<Vec2>(corners, 3 * static_cast<std::size_t>(corners.shape(0)));
    } else {
      kind_ = Kind::positions;
      read_rows(array, values_, place);
    }
  }

  /// The same on a mesh. @throws UsageError when the array is of another length.
  CornerAttribute<Vec2> on(const TriangleMesh& mesh) {
    switch (kind_) {
      case Kind::none: return {};
      case Kind::indexed: return *indexed_;
      case Kind::positions:
        check_length(mesh.positions.size(), "positions");
        return {std::move(values_), mesh.triangles};
      case Kind::corners: break;
    }
    check_length(3 * mesh.triangles.size(), "corners");
    CornerAttribute<Vec2> uv{std::move(values_), {}};
    uv.indices.resize(mesh.triangles.size());
    for (Index t = 0; t < uv.indices.size(); ++t) uv.indices[t] = {3 * t, 3 * t + 1, 3 * t + 2};
    return uv;
  }

  /// on() for as long as the mesh and what was given exist: looks into them.
  const CornerAttribute<Vec2>& seen_on(TriangleMesh& mesh) {
    if (kind_ == Kind::indexed) return *indexed_;
    if (kind_ == Kind::positions) {
      check_length(mesh.positions.size(), "positions");
      seen_ = {std::move(values_), borrowed_values<Triangle>({}, mesh.triangles.data(), mesh.triangles.size())};
    } else {
      seen_ = on(mesh);
    }
    return seen_;
  }

 private:
  enum class Kind { none, indexed, positions, corners };

  void check_length(std::size_t wanted, const char* what) const {
    if (values_.size() != wanted)
      throw UsageError(place_ + ": has " + std::to_string(values_.size()) + " values for " + std::to_string(wanted) +
                       " " + what);
  }

  Kind kind_ = Kind::none;
  std::string place_;
  const CornerAttribute<Vec2>* indexed_ = nullptr;
  Values<Vec2> values_;
  CornerAttribute<Vec2> seen_;
};

template <>
class Argument<UvInput> {
 public:
  Argument(py::handle given, const std::string& place) : value_(given, place) {}
  UvInput& get() { return value_; }

 private:
  UvInput value_;
};

}  // namespace papilla::python
