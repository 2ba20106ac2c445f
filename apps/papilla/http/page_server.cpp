// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/page_server.hpp"

#include <fcntl.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <limits>
#include <list>
#include <optional>
#include <set>
#include <string_view>
#include <thread>
#include <vector>

#include "http/admission.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/random_token.hpp"

namespace papilla::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::milliseconds;

constexpr milliseconds k_pulse{1000 / 60};
constexpr milliseconds k_linger{2000};
constexpr std::size_t k_linger_bytes = 16U << 20U;
constexpr std::size_t k_piece_bytes = 65536;  ///< Of a body; a client takes one within PageLimits::stall.
constexpr int k_stream_buffer_bytes = 32768;  ///< Of a stream in the system: about a hundred samples.
constexpr std::size_t k_other_files = 64;     ///< Descriptors left to the rest of the program.

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

/// Raises the process's limit of descriptors to `wanted` as far as the system lets it. @returns the limit.
std::size_t raise_descriptor_limit(std::size_t wanted) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  if (limit.rlim_cur < wanted) {
    limit.rlim_cur = std::min<rlim_t>(wanted, limit.rlim_max);
    ::setrlimit(RLIMIT_NOFILE, &limit);
  }
  return limit.rlim_cur;
}

/// Browsers and other programs that are started from here would keep the port and the connections open.
void close_on_exec(int socket) { ::fcntl(socket, F_SETFD, FD_CLOEXEC); }

}  // namespace

/// State of the server. Everything but its constructor and destructor runs in its thread.
class PageServer::Loop {
 public:
  Loop(PageRoutes routes, int port, const PageLimits& limits);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  std::string url() const { return admission_->url(); }

 private:
  class Connection;

  void accept();
  void add(tcp::socket socket);
  void pulse();
  bool admits(const http::request<http::string_body>& request) const;

  PageRoutes routes_;
  PageLimits limits_;
  std::optional<Admission> admission_;  ///< Once the port is known.
  std::list<Connection*> strangers_;    ///< The oldest first.
  std::set<Connection*> clients_;       ///< That showed the token.
  std::array<char, k_piece_bytes> discarded_{};
  asio::io_context context_{1};  ///< Owns the connections through their handlers, so it ends before what they refer to.
  tcp::acceptor acceptor_{context_};
  asio::steady_timer pulse_{context_};
  bool accepting_ = false;
  std::thread thread_;
};

/// A connection and its one request. Lives as long as one of its operations is under way.
class PageServer::Loop::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Loop& loop) : stream_(std::move(socket)), loop_(loop) {
    place_ = loop_.strangers_.insert(loop_.strangers_.end(), this);
  }
  ~Connection() { drop(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read_header() {
    parser_.header_limit(static_cast<std::uint32_t>(loop_.limits_.header_bytes));
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // Until the token was seen: 403 goes before 413.
    stream_.expires_after(loop_.limits_.request);
    http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end_of_bad_request(error);
      self->take_header();
    });
  }

  /// Sends what is new, to a client that has taken what was sent before.
  void send_news() {
    if (!news_ || sending_) return;
    text_ = news_(seen_);
    if (text_.empty()) return;
    sending_ = true;
    stream_.expires_after(loop_.limits_.stall);
    asio::async_write(stream_, asio::buffer(text_), [self = shared_from_this()](error_code error, std::size_t) {
      self->sending_ = false;
      if (error) self->drop();
    });
  }

  void drop() {
    if (!open_) return;
    open_ = false;
    if (place_) loop_.strangers_.erase(*place_);
    place_.reset();
    loop_.clients_.erase(this);
    news_ = nullptr;
    stream_.close();
  }

 private:
  void end_of_bad_request(error_code error) {
    const bool readable = error.category() == http::make_error_code(http::error::bad_method).category() &&
                          error != http::error::end_of_stream && error != http::error::partial_message;
    if (!readable) return drop();
    answer({error == http::error::body_limit ? 413U : 400U, {}, nullptr});
  }

  void take_header() {
    if (!loop_.admits(parser_.get())) return answer({403, {}, nullptr});
    if (loop_.clients_.size() >= loop_.limits_.clients) return answer({503, {}, nullptr});
    loop_.strangers_.erase(*place_);
    place_.reset();
    loop_.clients_.insert(this);
    if (parser_.content_length().value_or(0) > loop_.limits_.body_bytes) return answer({413, {}, nullptr});
    if (parser_.is_done()) return take_request();
    parser_.body_limit(loop_.limits_.body_bytes);
    stream_.expires_after(loop_.limits_.request);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end_of_bad_request(error);
      self->take_request();
    });
  }

  void take_request() {
    const auto& request = parser_.get();
    const std::string path(view(request.target()).substr(0, view(request.target()).find('?')));
    const PageRoutes& routes = loop_.routes_;
    try {
      if (request.method() == http::verb::get) {
        if (const auto found = routes.get.find(path); found != routes.get.end()) return answer(found->second());
        if (const auto found = routes.streams.find(path); found != routes.streams.end()) return stream(found->second);
      } else if (request.method() == http::verb::post) {
        if (const auto found = routes.post.find(path); found != routes.post.end())
          return answer(found->second(request.body()));
      } else {
        return answer({405, {}, nullptr});
      }
    } catch (const std::exception&) {
      return answer({500, {}, nullptr});
    }
    answer({404, {}, nullptr});
  }

  void answer(const PageAnswer& answer) {
    body_ = answer.body ? answer.body : std::make_shared<const std::string>();
    head(answer.status, answer.type);
    response_.body() = {body_->data(), body_->size()};
    response_.prepare_payload();
    send_piece([this] { linger(); });
  }

  void stream(const std::function<std::string(std::uint64_t&)>& news) {
    head(200, "text/event-stream");
    error_code ignored;
    stream_.socket().set_option(asio::socket_base::send_buffer_size(k_stream_buffer_bytes), ignored);
    send_piece([this, news] {
      news_ = news;
      // A client sends nothing after its request: what can be read is its end.
      stream_.socket().async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code) { self->drop(); });
      send_news();
    });
  }

  void head(unsigned status, const std::string& type) {
    response_.result(status);
    response_.version(11);
    response_.keep_alive(false);
    if (!type.empty()) response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Content-Security-Policy", page_policy());
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    serializer_.emplace(response_);
    serializer_->limit(k_piece_bytes);
  }

  /// Sends the response piece by piece and goes on with `next`.
  void send_piece(std::function<void()> next) {
    stream_.expires_after(loop_.limits_.stall);
    http::async_write_some(stream_, *serializer_,
                           [self = shared_from_this(), next = std::move(next)](error_code error, std::size_t) {
                             if (error) return self->drop();
                             if (self->serializer_->is_done()) return next();
                             self->send_piece(next);
                           });
  }

  /// Ends the connection when the client has, or after a while: closed over unread bytes, the system would take the
  /// answer back.
  void linger() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(k_linger);
    discard();
  }

  void discard() {
    stream_.async_read_some(asio::buffer(loop_.discarded_),
                            [self = shared_from_this()](error_code error, std::size_t bytes) {
                              self->discarded_bytes_ += bytes;
                              if (error || self->discarded_bytes_ > k_linger_bytes) return self->drop();
                              self->discard();
                            });
  }

  beast::tcp_stream stream_;
  Loop& loop_;
  bool open_ = true;
  std::optional<std::list<Connection*>::iterator> place_;  ///< Among the strangers.
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  SharedText body_;
  http::response<http::span_body<const char>> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
  std::size_t discarded_bytes_ = 0;
  std::function<std::string(std::uint64_t&)> news_;
  std::uint64_t seen_ = 0;
  std::string text_;
  bool sending_ = false;
};

PageServer::Loop::Loop(PageRoutes routes, int port, const PageLimits& limits)
    : routes_(std::move(routes)), limits_(limits) {
  const std::size_t files = raise_descriptor_limit(limits_.clients + limits_.strangers + k_other_files);
  const std::size_t each = (std::max(files, 2 * k_other_files) - k_other_files) / 2;
  limits_.clients = std::min(limits_.clients, each);
  limits_.strangers = std::min(limits_.strangers, each);
  try {
    acceptor_.open(tcp::v4());
    close_on_exec(acceptor_.native_handle());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));  // Connections of a server before this one are no matter.
    acceptor_.bind({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)});
    acceptor_.listen();
  } catch (const boost::system::system_error& error) {
    throw IoError("127.0.0.1:" + std::to_string(port) + ": the port can't be used: " + error.code().message());
  }
  admission_.emplace(acceptor_.local_endpoint().port(), random_token());
  accept();
  pulse();
  thread_ = std::thread([this] { context_.run(); });
}

PageServer::Loop::~Loop() {
  context_.stop();
  thread_.join();
  while (!strangers_.empty()) strangers_.front()->drop();
  while (!clients_.empty()) (*clients_.begin())->drop();
}

void PageServer::Loop::accept() {
  accepting_ = true;
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    accepting_ = false;
    if (!error) {
      add(std::move(socket));
    } else if (error == asio::error::no_descriptors || error == boost::system::errc::too_many_files_open_in_system) {
      if (!strangers_.empty()) strangers_.front()->drop();
      return;  // The next pulse tries again.
    }
    accept();
  });
}

void PageServer::Loop::add(tcp::socket socket) {
  if (strangers_.size() >= limits_.strangers) strangers_.front()->drop();
  close_on_exec(socket.native_handle());
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  std::make_shared<Connection>(std::move(socket), *this)->read_header();
}

void PageServer::Loop::pulse() {
  if (!accepting_) accept();
  for (Connection* client : clients_) client->send_news();
  pulse_.expires_after(k_pulse);
  pulse_.async_wait([this](error_code error) {
    if (!error) pulse();
  });
}

bool PageServer::Loop::admits(const http::request<http::string_body>& request) const {
  const auto values_of = [&](http::field name) {
    std::vector<std::string> values;
    const auto [first, last] = request.equal_range(name);
    for (auto field = first; field != last; ++field) values.emplace_back(view(field->value()));
    return values;
  };
  return admission_->admits({std::string(view(request.target())), values_of(http::field::host),
                             values_of(http::field::origin), values_of(http::field::referer)});
}

PageServer::PageServer(PageRoutes routes, int port, const PageLimits& limits)
    : loop_(std::make_unique<Loop>(std::move(routes), port, limits)), url_(loop_->url()) {}

PageServer::~PageServer() = default;

}  // namespace papilla::app
