// SPDX-License-Identifier: GPL-3.0-or-later
// websocketpp 0.8 is no C++20: this file is compiled as C++17 (apps/CMakeLists.txt).
#include "studio/studio_socket.hpp"

#include <fcntl.h>

#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <vector>
#include <websocketpp/config/asio.hpp>
#include <websocketpp/config/asio_no_tls.hpp>
#include <websocketpp/server.hpp>

namespace papilla::app {
namespace {

constexpr std::size_t k_most_message_bytes = 65536;
constexpr std::size_t k_most_waiting_bytes = std::size_t{64} << 20;
constexpr std::size_t k_newest_waiting_bytes = 65536;  ///< Above, a client is behind.
constexpr std::size_t k_most_clients = 16;
constexpr long k_handshake_ms = 5000;

using Plain = websocketpp::config::asio;
using Tls = websocketpp::config::asio_tls;
using Handle = websocketpp::connection_hdl;

std::shared_ptr<boost::asio::ssl::context> tls_context(const TlsFiles& tls) {
  using Context = boost::asio::ssl::context;
  auto context = std::make_shared<Context>(Context::tls_server);
  context->set_options(Context::default_workarounds | Context::no_sslv2 | Context::no_sslv3 | Context::no_tlsv1 |
                       Context::no_tlsv1_1);
  context->use_certificate_chain_file(tls.certificate);
  context->use_private_key_file(tls.key, Context::pem);
  return context;
}

}  // namespace

class StudioSocket::Server {
 public:
  Server() = default;
  virtual ~Server() = default;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  virtual int port() const noexcept = 0;
  virtual void start(SocketHandlers handlers) = 0;
  virtual void send(const std::string& payload, bool is_newest) = 0;
  virtual std::size_t clients() const = 0;
};

template <class Config>
class StudioSocket::ServerOf final : public StudioSocket::Server {
 public:
  using Endpoint = websocketpp::server<Config>;
  using Connection = typename Endpoint::connection_ptr;

  explicit ServerOf(const std::optional<TlsFiles>& tls) {
    endpoint_.clear_access_channels(websocketpp::log::alevel::all);
    endpoint_.clear_error_channels(websocketpp::log::elevel::all);
    endpoint_.init_asio();
    endpoint_.set_max_message_size(k_most_message_bytes);
    endpoint_.set_open_handshake_timeout(k_handshake_ms);
    using Address = boost::asio::ip::address_v4;
    if constexpr (std::is_same_v<Config, Tls>) {
      endpoint_.set_tls_init_handler([context = tls_context(*tls)](const Handle&) { return context; });
      endpoint_.listen(boost::asio::ip::tcp::endpoint(Address::any(), 0));
    } else {
      endpoint_.listen(boost::asio::ip::tcp::endpoint(Address::loopback(), 0));
    }
    boost::system::error_code error;
    port_ = endpoint_.get_local_endpoint(error).port();
    if (error) throw std::runtime_error("no port for a WebSocket: " + error.message());
  }

  ~ServerOf() override {
    endpoint_.get_io_service().post([this] { close(); });
    if (thread_.joinable()) thread_.join();
  }
  ServerOf(const ServerOf&) = delete;
  ServerOf& operator=(const ServerOf&) = delete;

  int port() const noexcept override { return port_; }

  void start(SocketHandlers handlers) override {
    handlers_ = std::move(handlers);
    endpoint_.set_validate_handler([this](const Handle& handle) { return validate(handle); });
    endpoint_.set_open_handler([this](const Handle& handle) { note(handle, true); });
    endpoint_.set_close_handler([this](const Handle& handle) { note(handle, false); });
    endpoint_.set_message_handler([this](const Handle&, const typename Endpoint::message_ptr& message) {
      if (message->get_opcode() == websocketpp::frame::opcode::text) handlers_.message(message->get_payload());
    });
    endpoint_.set_http_handler([this](const Handle& handle) {  // No request for a socket.
      const Connection connection = endpoint_.get_con_from_hdl(handle);
      connection->set_status(websocketpp::http::status_code::forbidden);
    });
    endpoint_.start_accept();
    thread_ = std::thread([this] { endpoint_.run(); });
  }

  void send(const std::string& payload, bool is_newest) override {
    std::vector<Connection> behind;  // What ends a connection calls note() at once.
    send_to_all(payload, is_newest, behind);
    for (const Connection& connection : behind) connection->terminate(websocketpp::lib::error_code());
  }

  std::size_t clients() const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return open_.size();
  }

 private:
  void send_to_all(const std::string& payload, bool is_newest, std::vector<Connection>& behind) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Handle& handle : open_) {
      websocketpp::lib::error_code error;
      const Connection connection = endpoint_.get_con_from_hdl(handle, error);
      if (error) continue;
      const std::size_t waiting = connection->get_buffered_amount();
      if (is_newest && waiting > k_newest_waiting_bytes) continue;
      if (waiting > k_most_waiting_bytes) {
        behind.push_back(connection);
        continue;
      }
      endpoint_.send(handle, payload, is_newest ? websocketpp::frame::opcode::binary : websocketpp::frame::opcode::text,
                     error);
    }
  }

  bool validate(const Handle& handle) {
    const Connection connection = endpoint_.get_con_from_hdl(handle);
    if (clients() < k_most_clients &&
        handlers_.admits(connection->get_resource(), connection->get_request_header("Host"),
                         connection->get_request_header("Origin")))
      return true;
    connection->set_status(websocketpp::http::status_code::forbidden);
    return false;
  }

  void note(const Handle& handle, bool is_open) {
    std::size_t count = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_open)
        open_.insert(handle);
      else
        open_.erase(handle);
      count = open_.size();
    }
    handlers_.changed(count);
  }

  void close() {
    websocketpp::lib::error_code ignored;
    endpoint_.stop_listening(ignored);
    std::set<Handle, std::owner_less<Handle>> open;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      open = open_;
    }
    for (const Handle& handle : open) endpoint_.close(handle, websocketpp::close::status::going_away, "", ignored);
    endpoint_.set_timer(k_close_ms, [this](const websocketpp::lib::error_code&) { endpoint_.stop(); });
  }

  static constexpr long k_close_ms = 200;
  Endpoint endpoint_;
  int port_ = 0;
  SocketHandlers handlers_;
  mutable std::mutex mutex_;
  std::set<Handle, std::owner_less<Handle>> open_;
  std::thread thread_;
};

StudioSocket::StudioSocket(const std::optional<TlsFiles>& tls) {
  if (tls)
    server_ = std::make_unique<ServerOf<Tls>>(tls);
  else
    server_ = std::make_unique<ServerOf<Plain>>(tls);
}
StudioSocket::~StudioSocket() = default;
int StudioSocket::port() const noexcept { return server_->port(); }
void StudioSocket::start(SocketHandlers handlers) { server_->start(std::move(handlers)); }
void StudioSocket::send(const std::string& text) { server_->send(text, false); }
void StudioSocket::send_newest(const std::string& bytes) { server_->send(bytes, true); }
std::size_t StudioSocket::clients() const { return server_->clients(); }

}  // namespace papilla::app
