// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <typeindex>
#include <utility>

/// What arrays and objects that look into a container rest on. They stay good when the container is assigned: what it
/// held moves to the storage that they share, and lives as long as they do.
namespace papilla::python {

namespace py = pybind11;

/// The storage of the container at `place`, within `owner`, which it keeps alive.
py::object storage_at(const void* place, std::type_index type, py::handle owner);

/// Gives the former content to the storage at `place`, when something still looks into it.
/// @param take  makes it; called at most once. @return whether there was such a storage.
bool retire_storage(const void* place, std::type_index type, const std::function<std::shared_ptr<void>()>& take);

/// Whether something looks into the container at `place`.
bool is_in_use(const void* place, std::type_index type);

/// For the module.
void add_storage(py::module_& module);

/// Moves what Python still looks at out of a vector or map that is about to be assigned.
template <class Container>
void retire(Container& container) {
  retire_storage(&container, typeid(Container), [&container]() -> std::shared_ptr<void> {
    return std::make_shared<Container>(std::exchange(container, Container{}));
  });
}

}  // namespace papilla::python
