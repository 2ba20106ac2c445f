// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stimulus_player.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/plain_number.hpp"

extern char** environ;

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_player = "papilla-player";

/// Installed and built, both programs lie in one folder.
std::string player_program() {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = own.parent_path() / k_player;
  return !error && ::access(beside.c_str(), X_OK) == 0 ? beside.string() : k_player;
}

/// A word of a command line as a shell reads it.
std::string quoted(const std::string& word) {
  constexpr const char* k_plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./:,=+-";
  if (!word.empty() && word.find_first_not_of(k_plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string StimulusPlayer::command(const fs::path& file) const {
  return std::string(k_player) + " " + quoted(file.string()) + " --device " +
         (device_.empty() ? std::string("hid") : quoted(device_)) + " --seconds " + plain_number(seconds_);
}

void StimulusPlayer::start(const fs::path& file) {
  stop();
  const std::scoped_lock lock(mutex_);
  failure_.clear();
  std::vector<std::string> words = {player_program(), fs::absolute(file).string(), "--device", device_,
                                    "--seconds",      plain_number(seconds_),      "--quiet"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int reason = ::posix_spawnp(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (reason != 0) throw DeviceError(std::string(k_player) + ": cannot be started: " + std::strerror(reason));
  child_ = child;
}

bool StimulusPlayer::is_playing() {
  const std::scoped_lock lock(mutex_);
  if (!child_) return false;
  int status = 0;
  if (::waitpid(*child_, &status, WNOHANG) != *child_) return true;
  take_status(status);
  return false;
}

std::string StimulusPlayer::wait() {
  const std::scoped_lock lock(mutex_);
  if (!child_) return failure_;
  int status = 0;
  while (::waitpid(*child_, &status, 0) < 0 && errno == EINTR) {
  }
  take_status(status);
  return failure_;
}

void StimulusPlayer::stop() {
  const std::scoped_lock lock(mutex_);
  if (!child_) return;
  ::kill(*child_, SIGINT);
  int status = 0;
  while (::waitpid(*child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_.reset();
}

std::string StimulusPlayer::failure() {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

void StimulusPlayer::take_status(int status) {
  child_.reset();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  failure_ = WIFEXITED(status) ? std::string(k_player) + " ended with " + std::to_string(WEXITSTATUS(status))
                               : std::string(k_player) + " was ended by signal " + std::to_string(WTERMSIG(status));
}

}  // namespace papilla::app
