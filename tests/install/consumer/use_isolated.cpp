// SPDX-License-Identifier: MIT
#include <papilla/io/isolated.hpp>
#include <papilla/io/scene_stream.hpp>

int main() {
  int sent = 7, received = 0;
  papilla::IsolatedWork work{"a.file", "a library", [](const papilla::ProgressCallback&) {},
                             [&](int pipe) {
                               papilla::ValueSender out(pipe);
                               out(sent);
                               out.flush();
                             },
                             [&](int pipe) {
                               papilla::ValueReceiver in(pipe);
                               in(received);
                             }};
  papilla::run_isolated(work, {});
  return received == sent ? 0 : 1;
}
