// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "http/page_server.hpp"
#include "papilla/pipeline/weather_scene.hpp"

namespace papilla::app {

/// What the pages that follow `weather --live` are told and given. Thread-safe: one thread makes looks, the server's
/// hands them out.
///
/// `/` is the page, `/live` tells by events "looks" which page, which version of the looks and which mistake there is
/// now, and `/looks` gives, for the body {"since": VERSION}, what has changed since: the length of a JSON text in four
/// bytes, least first, the text, and pixels that it tells the places of. Pictures that are the same as then have no
/// key.
class LiveLooks {
 public:
  /// A scene that is laid out anew: pages load themselves again.
  /// @param html  makes the page, of its number and the version of the looks that it shows.
  void show(const std::function<std::string(std::uint64_t page, std::uint64_t version)>& html,
            const WeatherLooks& looks);

  /// New looks of the scene that the page shows; a mistake is mended. @pre the layout is that of the looks before.
  void update(const WeatherLooks& looks);

  /// Whether a page has what is new. Others would take the processor from the page that still draws.
  bool is_taken() const;

  /// Why there are no newer looks; empty: nothing is wrong.
  void tell(const std::string& problem);

  /// Must not outlive this.
  PageRoutes routes();

 private:
  struct Look {
    std::shared_ptr<const WeatheredLook> look;
    std::uint64_t version = 0;                   ///< Since which it is this.
    std::array<std::uint64_t, 3> pictures = {};  ///< The same of its colour, normal and shine.
  };
  void take(const WeatherLooks& looks);
  std::string event(std::uint64_t& seen) const;
  SharedText changed_since(std::uint64_t version);

  mutable std::mutex mutex_;
  SharedText page_;
  std::uint64_t pages_ = 0, version_ = 0, taken_ = 0, events_ = 0;
  std::vector<Look> looks_;
  std::string problem_;
};

}  // namespace papilla::app
