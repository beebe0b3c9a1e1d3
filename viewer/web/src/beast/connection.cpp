// SPDX-License-Identifier: BSD-3-Clause
#include "beast/connection.h"

#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "vps_device/metronome.h"

namespace vps::viewer {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using ErrorCode = beast::error_code;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr std::chrono::seconds kRequestLimit{20};  // longest time for one request and its response
constexpr std::chrono::seconds kSilenceLimit{30};  // longest silence of a WebSocket; pings end the silence
constexpr std::size_t kLongestHeader = 8192;
// A browser that does not read is disconnected when this many messages or bytes wait to be sent.
constexpr std::size_t kMostWaiting = 512, kMostWaitingBytes = 4U << 20U;
// Size of the system's send buffer, small so that a slow browser gets recent snapshots.
constexpr int kSendBuffer = 64 * 1024;

using PlainStream = beast::tcp_stream;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

/// The WebSocket of one browser.
template <typename Stream>
class WebSocketEnd final : public BrowserEnd, public std::enable_shared_from_this<WebSocketEnd<Stream>> {
 public:
  WebSocketEnd(Stream stream, WebShared& shared) : socket_(std::move(stream)), shared_(shared) {
    ++shared_.connections;
  }
  ~WebSocketEnd() override {
    --shared_.connections;
    if (number_ != 0 && !shared_.is_over) shared_.hub.leave(number_);
  }

  void accept(const Request& request) {
    websocket::stream_base::timeout limits{kRequestLimit, kSilenceLimit, true};
    socket_.set_option(limits);
    socket_.read_message_max(kLongestBrowserMessage);
    socket_.async_accept(request, [self = this->shared_from_this()](ErrorCode failed) {
      if (failed || self->shared_.is_over) return;
      self->number_ = self->shared_.hub.join(*self);
      self->read();
    });
  }

  void sendText(std::string text) override { send(true, std::move(text)); }
  void sendBytes(std::string bytes) override { send(false, std::move(bytes)); }
  [[nodiscard]] bool isFree() const override { return waiting_.empty() && !is_closing_; }

 private:
  struct Waiting {
    bool is_text;
    std::string bytes;
  };

  void read() {
    socket_.async_read(buffer_, [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
      if (failed || self->is_closing_) return self->close();
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.clear();
      const bool is_good =
          self->socket_.got_text() && self->shared_.hub.hear(self->number_, text, webClock_s());
      if (!is_good) return self->close();
      self->read();
    });
  }
  void send(bool is_text, std::string bytes) {
    if (is_closing_) return;
    waiting_bytes_ += bytes.size();
    waiting_.push_back({is_text, std::move(bytes)});
    if (waiting_.size() > kMostWaiting || waiting_bytes_ > kMostWaitingBytes) return close();
    if (waiting_.size() == 1) write();
  }
  void write() {
    const Waiting& next = waiting_.front();
    socket_.text(next.is_text);
    socket_.async_write(boost::asio::buffer(next.bytes),
                        [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
                          if (failed || self->is_closing_) return self->close();
                          self->waiting_bytes_ -= self->waiting_.front().bytes.size();
                          self->waiting_.pop_front();
                          if (!self->waiting_.empty()) self->write();
                        });
  }
  /// Cancels all operations. The last operation to end deletes this object.
  void close() {
    if (std::exchange(is_closing_, true)) return;
    beast::get_lowest_layer(socket_).cancel();
    beast::get_lowest_layer(socket_).close();
  }

  websocket::stream<Stream> socket_;
  WebShared& shared_;
  beast::flat_buffer buffer_;
  std::deque<Waiting> waiting_;  ///< messages to send; the first one is being written
  std::size_t waiting_bytes_ = 0;
  bool is_closing_ = false;
  int number_ = 0;
};

std::string_view viewOf(beast::string_view text) {
  return {text.data(), text.size()};
}

/// Handles requests for files, one after the other.
template <typename Stream>
class HttpEnd : public std::enable_shared_from_this<HttpEnd<Stream>> {
 public:
  HttpEnd(Stream stream, WebShared& shared) : stream_(std::move(stream)), shared_(shared) {
    ++shared_.connections;
  }
  ~HttpEnd() { --shared_.connections; }

  void begin() {
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      lowest().expires_after(kRequestLimit);
      stream_.async_handshake(boost::asio::ssl::stream_base::server,
                              [self = this->shared_from_this()](ErrorCode failed) {
                                if (!failed && !self->shared_.is_over) self->read();
                              });
    } else {
      read();
    }
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(kLongestHeader);
    parser_->body_limit(0);
    lowest().expires_after(kRequestLimit);
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
                       if (failed || self->shared_.is_over) return self->end();
                       self->answer(self->parser_->get());
                     });
  }

 private:
  void answer(const Request& request) {
    const bool is_upgrade = websocket::is_upgrade(request);
    const WebAnswer answer = shared_.access.judge(
        {viewOf(request.method_string()), viewOf(request.target()), viewOf(request[http::field::host]),
         viewOf(request[http::field::origin]), viewOf(request[http::field::cookie]), is_upgrade});
    switch (answer) {
      case WebAnswer::BadMethod:
        return refuse(http::status::method_not_allowed, "only GET");
      case WebAnswer::BadHost:
        return refuse(http::status::forbidden, "open the page by the address that vps prints");
      case WebAnswer::BadOrigin:
        return refuse(http::status::forbidden, "a page of another server may not use this server");
      case WebAnswer::Unauthenticated:
        return refuse(http::status::unauthorized,
                      "open the page by the address that vps prints, with its token");
      case WebAnswer::SetCookie: {
        response_ = make(http::status::see_other, "text/plain", "");
        response_.set(http::field::location, "/");
        response_.set(http::field::set_cookie, shared_.access.setCookie());
        return write();
      }
      case WebAnswer::Good:
        break;
    }
    if (is_upgrade) return upgrade(request);
    const std::string_view target = viewOf(request.target());
    if (const WebFile* file = shared_.page.find(target))
      response_ = make(http::status::ok, file->type, file->bytes);
    else if (const std::shared_ptr<const std::string> part = shared_.hub.partFile(target))
      response_ = make(http::status::ok, "model/gltf-binary", *part);
    else
      return refuse(http::status::not_found, "there is no such page");
    write();
  }
  void upgrade(const Request& request) {
    if (viewOf(request.target()) != "/run") return refuse(http::status::not_found, "there is no such page");
    if (shared_.hub.browsers() >= shared_.most_browsers)
      return refuse(http::status::service_unavailable, "too many browsers watch this run");
    lowest().expires_never();  // the WebSocket has its own time limits
    std::make_shared<WebSocketEnd<Stream>>(std::move(stream_), shared_)->accept(request);
  }
  void refuse(http::status status, const char* words) {
    response_ = make(status, "text/plain; charset=utf-8", std::string(words) + "\n");
    response_.keep_alive(false);
    write();
  }
  [[nodiscard]] Response make(http::status status, const std::string& type, std::string body) const {
    Response response(status, 11, std::move(body));
    const std::string host(parser_->get()[http::field::host]);
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    const std::string socket = (shared_.access.isEncrypted() ? "wss://" : "ws://") + host;
    response.set("Content-Security-Policy",
                 "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self' " + socket +
                     "; img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    response.keep_alive(parser_->get().keep_alive());
    response.prepare_payload();
    return response;
  }
  void write() {
    http::async_write(stream_, response_, [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
      if (failed || self->response_.need_eof()) return self->end();
      self->read();
    });
  }
  void end() {
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      lowest().expires_after(kRequestLimit);
      stream_.async_shutdown([self = this->shared_from_this()](ErrorCode) {});
    } else {
      ErrorCode ignored;
      stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    }
  }
  beast::tcp_stream& lowest() { return beast::get_lowest_layer(stream_); }

  Stream stream_;
  WebShared& shared_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

}  // namespace

double webClock_s() {
  return 1e-9 * static_cast<double>(device::monotonicClock().now_ns());
}

void serveConnection(tcp::socket socket, WebShared& shared) {
  ErrorCode ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  if (shared.tls == nullptr)
    std::make_shared<HttpEnd<PlainStream>>(PlainStream(std::move(socket)), shared)->begin();
  else
    std::make_shared<HttpEnd<TlsStream>>(TlsStream(std::move(socket), *shared.tls), shared)->begin();
}

}  // namespace vps::viewer
