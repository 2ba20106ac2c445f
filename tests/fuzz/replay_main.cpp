// SPDX-License-Identifier: MIT
// Gives a fuzz target every file of the folders named on the command line, once.
// --mutations N: and N mutations of each, one after the other, if the target has a mutator of its own.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t max_size, unsigned seed);

namespace {

/// Every eighth mutation starts again from the file, as inputs of a growing corpus stay near to what works.
void run_mutations(const std::vector<std::uint8_t>& file, unsigned count) {
  std::vector<std::uint8_t> bytes(std::max<std::size_t>(4 * file.size(), 4096));
  std::size_t size = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    if (seed % 8 == 0)
      size = static_cast<std::size_t>(std::copy(file.begin(), file.end(), bytes.begin()) - bytes.begin());
    size = LLVMFuzzerCustomMutator(bytes.data(), size, bytes.size(), seed);
    if (const char* last = std::getenv("PAPILLA_FUZZ_LAST"))
      std::ofstream(last, std::ios::binary)
          .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(size));
    LLVMFuzzerTestOneInput(bytes.data(), size);
  }
}

}  // namespace

int main(int count, char** arguments) {
  unsigned mutations = 0;
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i) {
    if (arguments[i] == std::string_view("--mutations") && i + 1 < count)
      mutations = static_cast<unsigned>(std::stoul(arguments[++i]));
    else
      for (const auto& entry : std::filesystem::directory_iterator(arguments[i])) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    std::fprintf(stderr, "%s\n", file.c_str());  // The last one named is the one that failed.
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    if (mutations > 0 && LLVMFuzzerCustomMutator != nullptr) run_mutations(bytes, mutations);
  }
  std::printf("%zu files\n", files.size());
  return files.empty() ? 1 : 0;
}
