// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {

/// A mistake in the text of a recipe and its place there: "SOURCE: line 1, column 5: REASON".
class RecipeError : public InvalidInput {
 public:
  RecipeError(std::string source, std::size_t position, std::size_t line, std::size_t column, std::string reason)
      : InvalidInput(source + ": line " + std::to_string(line) + ", column " + std::to_string(column) + ": " + reason),
        source_(std::move(source)),
        reason_(std::move(reason)),
        position_(position) {}

  /// Name of the text: CompileOptions::source, or that of a recipe of the library which the text uses.
  const std::string& source() const noexcept { return source_; }
  const std::string& reason() const noexcept { return reason_; }
  std::size_t position() const noexcept { return position_; }  ///< Bytes from the beginning of the text.

 private:
  std::string source_, reason_;
  std::size_t position_;
};

}  // namespace papilla
