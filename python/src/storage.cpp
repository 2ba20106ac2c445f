// SPDX-License-Identifier: MIT
#include "storage.hpp"

#include <map>
#include <utility>

namespace papilla::python {
namespace {

using Key = std::pair<const void*, std::type_index>;

struct Storage {
  Storage(Key key_of, py::object owner_of) : key(key_of), owner(std::move(owner_of)) {}
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;
  ~Storage();

  Key key;
  py::object owner;
  std::shared_ptr<void> retired;
};

/// Storages that have not been retired. Only touched with the GIL; never destroyed, as views may outlive the module.
std::map<Key, PyObject*>& living() {
  static auto* storages = new std::map<Key, PyObject*>;
  return *storages;
}

Storage::~Storage() {
  if (!retired) living().erase(key);
}

}  // namespace

py::object storage_at(const void* place, std::type_index type, py::handle owner) {
  const Key key{place, type};
  if (const auto found = living().find(key); found != living().end())
    return py::reinterpret_borrow<py::object>(found->second);
  py::object made = py::cast(std::make_unique<Storage>(key, py::reinterpret_borrow<py::object>(owner)));
  living().emplace(key, made.ptr());
  return made;
}

bool retire_storage(const void* place, std::type_index type, const std::function<std::shared_ptr<void>()>& take) {
  const auto found = living().find({place, type});
  if (found == living().end()) return false;
  Storage& storage = py::handle(found->second).cast<Storage&>();
  storage.retired = take();
  living().erase(found);
  return true;
}

bool is_in_use(const void* place, std::type_index type) { return living().contains({place, type}); }

void add_storage(py::module_& module) { py::class_<Storage>(module, "_Storage", py::module_local()); }

}  // namespace papilla::python
