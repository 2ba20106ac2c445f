// SPDX-License-Identifier: MIT
#include <papilla/io/isolated.hpp>
#include <papilla/io/pipe_stream.hpp>

int main() {
  int sent = 7, received = 0;
  papilla::IsolatedWork work{"a.file", "a library", [](const papilla::ProgressCallback&) {},
                             [&](int pipe) { papilla::send_values(pipe, sent); },
                             [&](int pipe) { papilla::receive_values(pipe, received); }};
  papilla::run_isolated(work, {});
  return received == sent ? 0 : 1;
}
