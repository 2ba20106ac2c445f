// SPDX-License-Identifier: MIT
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "papilla/core/error.hpp"

/// The folder for what running programs of one user tell each other; nobody else can enter it.
namespace papilla::app {

/// Why this is no folder into which the user alone may write; empty when it is one.
inline std::string why_not_of_user(const std::string& folder) {
  struct stat about {};
  if (::lstat(folder.c_str(), &about) != 0) return std::strerror(errno);
  if (S_ISLNK(about.st_mode)) return "is a symbolic link";
  if (!S_ISDIR(about.st_mode)) return "is no folder";
  if (about.st_uid != ::geteuid()) return "belongs to user " + std::to_string(about.st_uid);
  if ((about.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "can be written by other users";
  return {};
}

/// @throws InvalidInput when others may exchange what lies in the folder.
inline void require_folder_of_user(const std::string& folder) {
  const std::string why = why_not_of_user(folder);
  if (!why.empty()) throw InvalidInput(folder + ": must be a folder of this user alone, but: " + why);
}

/// $XDG_RUNTIME_DIR/papilla, or /tmp/papilla-UID where the user has no such folder.
inline std::string user_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime == '/' && why_not_of_user(runtime).empty())
    return std::string(runtime) + "/papilla";
  return "/tmp/papilla-" + std::to_string(::geteuid());
}

/// user_folder(), made when it is missing, with mode 0700. @throws InvalidInput as require_folder_of_user().
inline std::string make_user_folder() {
  const std::string folder = user_folder();
  ::mkdir(folder.c_str(), S_IRWXU);
  require_folder_of_user(folder);
  ::chmod(folder.c_str(), S_IRWXU);  // Of one that was there before, or was made under another umask.
  return folder;
}

}  // namespace papilla::app
