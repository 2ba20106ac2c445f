// SPDX-License-Identifier: MIT
#include <papilla/cache/stage_cache.hpp>
#include <papilla/core/temporary_folder.hpp>

int main() {
  const papilla::TemporaryFolder folder("consumer");
  const papilla::StageCache cache{papilla::ContentStore(folder.path())};
  int made = 0;
  for (int i = 0; i < 2; ++i)
    papilla::remembered(
        &cache, "number", papilla::CacheUse::read_write, [&] { return ++made; }, 7);
  return made == 1 ? 0 : 1;
}
