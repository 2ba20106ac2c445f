// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_http.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <memory>
#include <thread>
#include <vector>

#include "json/json.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

constexpr std::size_t k_threads = 24;
constexpr int k_read_timeout_s = 10;
/// A page that draws in software takes nothing of an answer meanwhile; only those who are admitted get long ones.
constexpr int k_write_timeout_s = 60;
constexpr std::size_t k_most_upload_bytes = std::size_t{8} << 30;
constexpr int k_forbidden = 403, k_not_found = 404, k_conflict = 409, k_too_large = 413;

std::vector<std::string> values_of(const httplib::Request& request, const char* name) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < request.get_header_value_count(name); ++i)
    values.push_back(request.get_header_value(name, i));
  return values;
}

Query query_of(const httplib::Request& request) {
  Query query;
  for (const auto& [name, value] : request.params) query.try_emplace(name, value);
  return query;
}

std::string error_text(const std::string& reason) {
  return Json{{"error", reason}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// What has no body is sent at once; a shared one without a copy.
void answer(const PageAnswer& made, httplib::Response& response) {
  response.status = static_cast<int>(made.status);
  if (!made.body) return;
  const SharedText body = made.body;
  response.set_content_provider(body->size(), made.type.c_str(),
                                [body](std::size_t at, std::size_t count, httplib::DataSink& sink) {
                                  return sink.write(body->data() + at, std::min(count, body->size() - at));
                                });
  if (body->empty()) response.set_content("", made.type.c_str());
}

template <class Work>
void told(httplib::Response& response, const Work& work) {
  try {
    answer(work(), response);
  } catch (const std::exception& error) {
    response.status = k_conflict;
    response.set_content(error_text(error.what()), "application/json");
  }
}

}  // namespace

class StudioHttp::Server {
 public:
  explicit Server(const std::optional<TlsFiles>& tls)
      : http_(tls ? std::make_unique<httplib::SSLServer>(tls->certificate.c_str(), tls->key.c_str())
                  : std::make_unique<httplib::Server>()) {
    if (!http_->is_valid()) throw InvalidInput(tls->certificate + ": the server can't use it");
    http_->new_task_queue = [] { return new httplib::ThreadPool(k_threads); };
    http_->set_keep_alive_max_count(1);  // A body that is refused unread ends its connection.
    http_->set_read_timeout(k_read_timeout_s);
    http_->set_write_timeout(k_write_timeout_s);
    http_->set_payload_max_length(k_most_upload_bytes);
    http_->set_tcp_nodelay(true);
    // The library's own choice lets a second program listen on the same port.
    http_->set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
  }

  /// @returns the port; not above 0 where it can't be used.
  int bind(const char* address, int port) {
    if (port == 0) return http_->bind_to_any_port(address);
    return http_->bind_to_port(address, port) ? port : -1;
  }

  void begin(StudioRoutes routes, const Admission& admission, const std::string& connect) {
    routes_ = std::move(routes);
    http_->set_default_headers({{"Cache-Control", "no-store"},
                                {"X-Content-Type-Options", "nosniff"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Content-Security-Policy", page_policy(connect)},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Cross-Origin-Opener-Policy", "same-origin"}});
    using Handled = httplib::Server::HandlerResponse;
    http_->set_pre_routing_handler([admission](const httplib::Request& request, httplib::Response& response) {
      if (admission.admits({request.target, values_of(request, "Host"), values_of(request, "Origin"),
                            values_of(request, "Referer")}))
        return Handled::Unhandled;
      response.status = k_forbidden;
      return Handled::Handled;
    });
    http_->Get(".*", [this](const httplib::Request& request, httplib::Response& response) { get(request, response); });
    http_->Post(".*", [this](const httplib::Request& request, httplib::Response& response,
                             const httplib::ContentReader& reader) { post(request, response, reader); });
    thread_ = std::thread([this] { http_->listen_after_bind(); });
  }

  void end() {
    http_->stop();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void get(const httplib::Request& request, httplib::Response& response) {
    const auto found = routes_.get.find(request.path);
    if (found == routes_.get.end()) {
      response.status = k_not_found;
      return;
    }
    told(response, [&] { return found->second(query_of(request)); });
  }

  void post(const httplib::Request& request, httplib::Response& response, const httplib::ContentReader& reader) {
    if (request.is_multipart_form_data()) {
      response.status = k_not_found;
      return;
    }
    if (const auto found = routes_.uploads.find(request.path); found != routes_.uploads.end())
      return told(response, [&] {
        return found->second(query_of(request), [&](const std::function<bool(std::string_view)>& take) {
          return reader([&](const char* data, std::size_t size) { return take({data, size}); });
        });
      });
    const auto found = routes_.post.find(request.path);
    if (found == routes_.post.end()) {
      response.status = k_not_found;
      return;
    }
    std::string body;
    const std::size_t announced = request.get_header_value<std::uint64_t>("Content-Length");
    const bool whole = announced <= k_most_body_bytes && reader([&](const char* data, std::size_t size) {
                         body.append(data, size);
                         return body.size() <= k_most_body_bytes;
                       });
    if (!whole) {
      response.status = k_too_large;
      return;
    }
    told(response, [&] { return found->second(query_of(request), body); });
  }

  std::unique_ptr<httplib::Server> http_;
  StudioRoutes routes_;
  std::thread thread_;
};

StudioHttp::StudioHttp(int port, const std::optional<TlsFiles>& tls) : server_(std::make_unique<Server>(tls)) {
  const char* address = tls ? "0.0.0.0" : "127.0.0.1";
  port_ = server_->bind(address, port);
  if (port_ <= 0) throw IoError(std::string(address) + ":" + std::to_string(port) + ": the port can't be used");
}

StudioHttp::~StudioHttp() { server_->end(); }

void StudioHttp::start(StudioRoutes routes, const Admission& admission, const std::string& connect) {
  server_->begin(std::move(routes), admission, connect);
}

}  // namespace papilla::app
