// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stimulus_player.hpp"

#include <unistd.h>

#include <csignal>
#include <system_error>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/plain_number.hpp"

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
  try {
    child_.emplace(std::move(words));
  } catch (const IoError& error) {
    throw DeviceError(error.what());
  }
}

bool StimulusPlayer::is_playing() {
  const std::scoped_lock lock(mutex_);
  if (!child_) return false;
  if (child_->is_running()) return true;
  finish();
  return false;
}

std::string StimulusPlayer::wait() {
  const std::scoped_lock lock(mutex_);
  if (child_) finish();
  return failure_;
}

void StimulusPlayer::stop() {
  const std::scoped_lock lock(mutex_);
  if (!child_) return;
  child_->send(SIGINT);
  child_->wait();
  child_.reset();
}

std::string StimulusPlayer::failure() {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

void StimulusPlayer::finish() {
  const ChildEnd end = child_->wait();
  child_.reset();
  if (end.exit_code == 0) return;
  failure_ = std::string(k_player) + (end.signal != 0 ? " was ended by signal " + std::to_string(end.signal)
                                                      : " ended with " + std::to_string(end.exit_code));
  if (!end.messages.empty()) failure_ += ": " + end.messages;
}

}  // namespace papilla::app
