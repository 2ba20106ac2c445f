// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ply_header.hpp"

namespace papilla {

/// The numbers behind a PLY header, one after the other. Nothing is allocated that the bytes left could not fill.
class PlyBody {
 public:
  /// @param bytes  the whole file.
  PlyBody(std::string_view bytes, const PlyHeader& header, const std::string& file)
      : bytes_(bytes), format_(header.format), at_(header.size), file_(file) {}

  /// @throws InvalidInput naming the line or byte, as everything here, when the file ends or holds no number.
  double number(PlyType type);

  /// A list's numbers.
  void list(const PlyProperty& property, std::vector<double>& values);

  void skip(const PlyElement& element);

  std::size_t position() const noexcept { return at_; }
  void go_to(std::size_t position) noexcept { at_ = position; }

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::size_t list_length(const PlyProperty& property);

  std::string_view bytes_;
  PlyFormat format_;
  std::size_t at_;
  const std::string& file_;
};

}  // namespace papilla
