// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/bake_arguments.hpp"
#include "studio/studio_http.hpp"
#include "verb.hpp"

namespace papilla::app {

struct StudioOptions {
  BakeArguments arguments;        ///< What a bake of the studio gets.
  std::vector<std::string> more;  ///< Their words on a command line, without scene and materials.
  int port = 0;
  std::string token;            ///< Empty: a random one.
  std::optional<TlsFiles> tls;  ///< For others in the network; null: on 127.0.0.1 alone.
  double close_s = 4;           ///< After the last window was closed; the program ends then.
};

/// The studio: a document of materials for a scene, edited in a browser, with all that serves it.
class StudioSession {
 public:
  /// Opens the ports and begins to serve; scene and document are read in a thread.
  /// @throws IoError, InvalidInput.
  StudioSession(const StudioOptions& options, const VerbContext& context);
  ~StudioSession();  ///< Ends what runs.
  StudioSession(const StudioSession&) = delete;
  StudioSession& operator=(const StudioSession&) = delete;

  std::string url() const;
  int port() const;

  /// Serves until `stops` or the last window has been closed for a while; then saves. @throws IoError when that fails:
  /// what was kept stays.
  void run(const std::function<bool()>& stops);

 private:
  class Studio;
  std::unique_ptr<Studio> studio_;
};

/// The bundled page of the studio; empty when the program was built without it.
std::string_view studio_template() noexcept;

}  // namespace papilla::app
