// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace papilla::app {

/// Gives a file or an address to the desktop's browser, which outlives this program. Other users of the machine can
/// read the address, as it stands on a command line. @returns false when no browser could be started.
bool open_in_browser(const std::string& page);

/// A file in user_folder(), which nobody else can read, that leads a browser to a page server, so that the server's
/// token stands on no command line. Removed with the object.
class PageDoor {
 public:
  /// @param url of a PageServer. @throws InvalidInput, IoError when it can't be written.
  explicit PageDoor(const std::string& url);
  ~PageDoor();
  PageDoor(const PageDoor&) = delete;
  PageDoor& operator=(const PageDoor&) = delete;

  const std::filesystem::path& file() const noexcept { return file_; }

 private:
  std::filesystem::path file_;
};

}  // namespace papilla::app
