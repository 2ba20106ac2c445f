// SPDX-License-Identifier: MIT
// Gives a fuzz target every file of the folders named on the command line, once.
// --mutations N: and N mutations of each file that its reader accepts, by the target's own mutator; fails when less
// than half of them get past the reader. The last input is kept in the file that PAPILLA_FUZZ_LAST names.
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

#include "fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t max_size, unsigned seed);

namespace {

using papilla::fuzz::counts;

void keep(const std::uint8_t* data, std::size_t size) {
  if (const char* const last = std::getenv("PAPILLA_FUZZ_LAST"); last != nullptr)
    std::ofstream(last, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
}

/// Every fourth mutation starts again from the file, as libFuzzer starts from inputs that found something.
void run_mutations(const std::vector<std::uint8_t>& file, unsigned first_seed, unsigned count) {
  constexpr unsigned k_chain = 4;
  std::vector<std::uint8_t> bytes(std::max<std::size_t>(4 * file.size(), 4096));
  std::size_t size = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    if (seed % k_chain == 0) {
      std::copy(file.begin(), file.end(), bytes.begin());
      size = file.size();
    }
    size = LLVMFuzzerCustomMutator(bytes.data(), size, bytes.size(), first_seed + seed);
    keep(bytes.data(), size);
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
  std::size_t mutated = 0, accepted = 0;
  for (const std::filesystem::path& file : files) {
    std::fprintf(stderr, "%s\n", file.c_str());  // The last one named is the one that failed.
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const std::size_t before = counts().accepted;
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    if (mutations == 0 || LLVMFuzzerCustomMutator == nullptr || counts().accepted == before) continue;
    const papilla::fuzz::Counts start = counts();
    run_mutations(bytes, static_cast<unsigned>(mutated), mutations);
    mutated += counts().inputs - start.inputs;
    accepted += counts().accepted - start.accepted;
  }
  std::printf("%zu files; %zu of %zu mutations got past the reader\n", files.size(), accepted, mutated);
  return files.empty() || 2 * accepted < mutated ? 1 : 0;
}
