// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf_document.hpp"

namespace papilla::gltf {

/// Reads accessors; every offset, stride and count is checked against the buffers before anything is
/// allocated. One object serves a whole file and limits the sum of what it hands out.
class AccessorReader {
 public:
  explicit AccessorReader(const Document& document);

  /// Components of all elements, one after the other, as numbers: normalized integers become [0, 1] or [−1, 1].
  /// @param components  what the accessor's type must have (VEC3: 3).
  /// @param where       how messages name the use, for example "mesh 0, primitive 1, POSITION".
  /// @throws InvalidInput naming file, use, accessor and reason; also when a number is not finite.
  std::vector<double> numbers(int accessor, int components, const std::string& where);

  /// The elements of a scalar accessor of unsigned integers.
  std::vector<std::uint32_t> indices(int accessor, const std::string& where);

  /// @throws InvalidInput when the accessor does not exist.
  const tinygltf::Accessor& accessor(int number, const std::string& where) const;

  /// The bytes of a buffer view.
  std::span<const unsigned char> view(int number, const std::string& where) const;

 private:
  struct Elements;
  [[noreturn]] void fail(const std::string& where, const std::string& reason) const;
  void spend(std::size_t elements, const std::string& where);
  Elements elements(int view, std::size_t offset, std::size_t count, int component_type, int components, bool strided,
                    const std::string& where) const;
  void apply_sparse(const tinygltf::Accessor& accessor, int components, std::vector<double>& values,
                    const std::string& where) const;
  std::vector<double> raw_numbers(const tinygltf::Accessor& accessor, int components, const std::string& where);

  const Document& document_;
  std::size_t budget_ = 0;
};

}  // namespace papilla::gltf
