// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/browser.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "html_text.hpp"
#include "papilla/core/atomic_file.hpp"
#include "user_folder.hpp"

namespace papilla::app {

bool open_in_browser(const std::string& page) {
  const pid_t child = ::fork();
  if (child < 0) return false;
  if (child == 0) {
    if (!::freopen("/dev/null", "w", stdout) || !::freopen("/dev/null", "w", stderr)) ::_exit(127);
    ::execlp("xdg-open", "xdg-open", page.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

PageDoor::PageDoor(const std::string& url)
    : file_(std::filesystem::path(make_user_folder()) / ("page-" + std::to_string(::getpid()) + ".html")) {
  write_atomically(file_,
                   "<!doctype html><meta charset=\"utf-8\"><title>Papilla</title>\n"
                   "<meta http-equiv=\"refresh\" content=\"0; url=" +
                       html_text(url) + "\">\n");
}

PageDoor::~PageDoor() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace papilla::app
