// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/browser.hpp"

#include <unistd.h>

#include <system_error>

#include "html_text.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/child_process.hpp"
#include "papilla/core/error.hpp"
#include "user_folder.hpp"

namespace papilla::app {

bool open_in_browser(const std::string& page) {
  try {
    return ChildProcess({"xdg-open", page}).wait().exit_code == 0;
  } catch (const IoError&) {
    return false;
  }
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
