// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

/// What all fuzz targets share. A target is a function LLVMFuzzerTestOneInput(); libFuzzer's main() calls it with
/// inputs that it invents (preset `fuzz`), the replay program's with the files of the corpus (every other build).
namespace papilla::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A file of this process in the folder for temporary files. The same name gives the same file, overwritten.
std::filesystem::path write_input(const std::string& name, std::string_view content);

/// Runs a reader. An Error of one line is a proper refusal, printed when PAPILLA_FUZZ_SAY is set; anything else ends
/// the program.
/// @returns whether there was a result.
bool expect_result_or_refusal(const std::function<void()>& read);

/// The same for the reader that an input is made for, with count.
bool expect_read(const std::function<void()>& read);

/// Inputs that were given to expect_read(), and those of them with a result. Printed when the program ends properly.
struct Counts {
  std::size_t inputs = 0, accepted = 0;
};
const Counts& counts();

/// Ends the program when the condition does not hold.
void require(bool condition, const char* promise);

}  // namespace papilla::fuzz
