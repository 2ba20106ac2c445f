// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_bake.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string_view>
#include <utility>

#include "json/json.hpp"

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_look{100};

/// The same with what a studio needs of a child: progress to be read, on standard error.
std::vector<std::string> child_words(std::vector<std::string> words) {
  words.front() = "/proc/self/exe";
  words.insert(words.begin() + 2, {"--progress", "json"});
  return words;
}

bool is_progress(std::string_view line) { return line.starts_with("{\"stage\":"); }

/// The newest line of progress.
StudioBake::News news_of(const std::string& messages) {
  StudioBake::News news;
  const std::size_t line = messages.rfind("{\"stage\":");
  if (line == std::string::npos) return news;
  const Json json = Json::parse(messages.substr(line, messages.find('\n', line) - line), nullptr, false);
  if (!json.is_object()) return news;  // Half a line.
  news.stage = json.value("stage", std::string());
  news.fraction = json.value("fraction", 0.0);
  return news;
}

/// What is left when lines of progress are taken out.
std::string without_progress(std::string_view messages) {
  std::string text;
  while (!messages.empty()) {
    const std::string_view line = messages.substr(0, messages.find('\n'));
    messages.remove_prefix(std::min(line.size() + 1, messages.size()));
    if (!is_progress(line)) text.append(line).append("\n");
  }
  return text;
}

}  // namespace

std::string shell_line(const std::vector<std::string>& words) {
  constexpr std::string_view k_plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=@%+,-";
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && word.find_first_not_of(k_plain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

StudioBake::StudioBake(std::vector<std::string> words, std::function<void(const News&)> tell)
    : tell_(std::move(tell)), child_(child_words(std::move(words))), thread_([this] { follow(); }) {}

StudioBake::~StudioBake() {
  cancel();
  thread_.join();
}

void StudioBake::cancel() noexcept { is_cancelled_ = true; }

void StudioBake::follow() {
  bool was_told_to_end = false;
  while (child_.is_running()) {
    if (is_cancelled_ && !std::exchange(was_told_to_end, true)) child_.send(SIGTERM);
    tell_(news_of(child_.messages()));
    std::this_thread::sleep_for(k_look);
  }
  const ChildEnd end = child_.wait();
  News news;
  news.state = end.exit_code == 0 ? News::State::done : was_told_to_end ? News::State::cancelled : News::State::failed;
  news.messages = without_progress(end.messages);
  is_running_ = false;
  tell_(news);
}

}  // namespace papilla::app
