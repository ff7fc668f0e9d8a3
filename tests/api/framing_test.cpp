// What comes over a connection: every way in which a request may be malformed, slow or hostile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <ctime>
#include <thread>

#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;

const std::string host = "Host: here\r\n";

std::string post_text(const std::string& headers, const std::string& body = "") {
  return "POST /v1/plan HTTP/1.1\r\n" + host + headers + "\r\n" + body;
}

std::string get_text(const std::string& headers = "", const std::string& target = "/healthz") {
  return "GET " + target + " HTTP/1.1\r\n" + host + headers + "\r\n";
}

const std::string closing = "Connection: close\r\n";

TEST(Framing, ABodyInChunksIsRefused) {
  const auto answer =
      exchange(post_text("Transfer-Encoding: chunked\r\n", "2\r\n{}\r\n0\r\n\r\n"));
  EXPECT_EQ(status_of(answer), 411);
  EXPECT_NE(answer.find("application/problem+json"), std::string::npos);
  EXPECT_EQ(count(answer, "HTTP/1.1"), 1u);
}

TEST(Framing, ABodyWithoutLengthIsRefused) {
  EXPECT_EQ(status_of(exchange(post_text("", "{}"))), 411);
}

TEST(Framing, AMethodThatIsNotTakenNeedsNoLength) {
  for (const std::string method : {"PUT", "PATCH", "DELETE"}) {
    const auto answer =
        exchange(method + " /v1/render HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n");
    EXPECT_EQ(status_of(answer), 405) << method;
    EXPECT_NE(answer.find("\r\nAllow: GET, HEAD, POST, OPTIONS\r\n"), std::string::npos)
        << answer;
  }
}

TEST(Framing, ALengthThatIsGivenTwiceIsRefused) {
  EXPECT_EQ(status_of(exchange(
                post_text("Content-Length: 2\r\nTransfer-Encoding: chunked\r\n", "0\r\n\r\n"))),
            400);
  EXPECT_EQ(status_of(exchange(post_text("Content-Length: 2\r\nContent-Length: 2\r\n", "{}"))),
            400);
}

TEST(Framing, ALengthThatIsNotANumberIsRefused) {
  for (const auto* length : {"-1", "+2", "2, 2", "0x2", "2 2", ""}) {
    EXPECT_EQ(
        status_of(exchange(post_text("Content-Length: " + std::string(length) + "\r\n", "{}"))),
        400)
        << length;
  }
}

TEST(Framing, ABodyOverTheLimitIsRefusedBeforeItIsSent) {
  EXPECT_EQ(status_of(exchange(post_text("Content-Length: 99999999999\r\n"))), 413);
  EXPECT_EQ(status_of(exchange(post_text("Content-Length: 99999999999999999999999\r\n"))), 413);
}

TEST(Framing, LongBodiesShareTheirMemoryAndAnnouncedOnesTakeNone) {
  Config config = free_port();
  config.max_body_mb = 4;
  config.frame_memory_mb = 1;  // as much for bodies, and at least one
  Daemon daemon(config);
  daemon.start();
  const auto head = [](std::size_t bytes) {
    return post_text("Connection: close\r\nContent-Length: " + std::to_string(bytes) + "\r\n");
  };
  constexpr std::size_t mib = std::size_t{1} << 20;
  RawClient announced(daemon.port()), half_sent(daemon.port()), other(daemon.port());
  announced.send(head(4 * mib));
  half_sent.send(head(4 * mib) + std::string(4 * mib - 1, 'x'));
  std::this_thread::sleep_for(300ms);
  other.send(head(3 * mib) + std::string(3 * mib, 'x'));
  EXPECT_EQ(status_of(other.receive()), 503);
  half_sent.close();
  std::this_thread::sleep_for(300ms);
  RawClient again(daemon.port());
  again.send(head(3 * mib) + std::string(3 * mib, 'x'));
  EXPECT_EQ(status_of(again.receive()), 400);
  announced.close();
  daemon.stop();
}

TEST(Framing, AClientThatAsksFirstIsToldToContinue) {
  RawClient raw;
  raw.send(post_text("Expect: 100-continue\r\nContent-Length: 2\r\n" + closing));
  std::this_thread::sleep_for(100ms);
  raw.send("{}");
  const auto answer = raw.receive(60s);  // a first plan, which the server's closing ends
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200")) << answer;
}

TEST(Framing, AnotherExpectationIsRefused) {
  EXPECT_EQ(status_of(exchange(post_text("Expect: coffee\r\nContent-Length: 2\r\n", "{}"))),
            417);
}

TEST(Framing, ACompressedBodyIsRefused) {
  EXPECT_EQ(
      status_of(exchange(post_text("Content-Encoding: gzip\r\nContent-Length: 2\r\n", "{}"))),
      415);
}

TEST(Framing, AMultipartBodyIsRefused) {
  EXPECT_EQ(
      status_of(exchange(post_text(
          "Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 2\r\n", "{}"))),
      415);
}

TEST(Framing, AnAddressThatIsTooLongIsRefused) {
  EXPECT_EQ(status_of(exchange(get_text("", "/" + std::string(9000, 'a')))), 414);
}

TEST(Framing, AnEndlessRequestLineIsRefused) {
  EXPECT_EQ(status_of(exchange("GET /" + std::string(40000, 'a'))), 414);
}

TEST(Framing, HeadersThatAreTooLongAreRefused) {
  EXPECT_EQ(status_of(exchange(get_text("X: " + std::string(40000, 'a') + "\r\n"))), 431);
  EXPECT_EQ(status_of(exchange("GET /healthz HTTP/1.1\r\nX: " + std::string(40000, 'a'))), 431);
}

TEST(Framing, AHeadThatDoesNotEndIsGivenUp) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(status_of(exchange("GET /healthz HTTP/1.1\r\nHost: h")), 408);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 3s);
}

TEST(Framing, AHeadThatDripsIsGivenUpAllTheSame) {
  RawClient raw;
  std::string answer;
  for (int i = 0; i < 15 && answer.empty(); ++i) {
    raw.send("G");
    answer = raw.receive(100ms);
  }
  EXPECT_EQ(status_of(answer), 408);
}

TEST(Framing, ABodyThatDoesNotComeIsGivenUp) {
  EXPECT_EQ(status_of(exchange(post_text("Content-Length: 10\r\n", "{"))), 408);
}

TEST(Framing, MalformedHeadsAreRefused) {
  const std::string heads[] = {
      "GET /healthz\r\n" + host + "\r\n",
      "GET  /healthz HTTP/1.1\r\n" + host + "\r\n",
      "GET /health z HTTP/1.1\r\n" + host + "\r\n",
      "G\x01T /healthz HTTP/1.1\r\n" + host + "\r\n",
      "GET /healthz HTTP/1.1\r\n\r\n",
      "GET /healthz HTTP/1.1\r\n" + host + host + "\r\n",
      get_text("no colon\r\n"),
      get_text("Space : 1\r\n"),
      get_text(" folded: 1\r\n"),
      get_text("X: a\x01z\r\n"),
      get_text("X: a\rb\r\n"),
      get_text("X: a\nContent-Length: 5\r\n"),
      get_text("", "/%zz"),
      get_text("", "/v1/render?a=%2"),
  };
  for (const auto& head : heads) EXPECT_EQ(status_of(exchange(head)), 400) << head;
}

TEST(Framing, AnotherVersionIsRefused) {
  EXPECT_EQ(status_of(exchange("GET /healthz HTTP/2.0\r\n" + host + "\r\n")), 505);
}

TEST(Framing, TheBodyOfAGetIsNeverTakenForARequest) {
  const auto inner = get_text("", "/v1/limits");
  const auto answer =
      exchange(get_text("Content-Length: " + std::to_string(inner.size()) + "\r\n") + inner);
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(count(answer, "HTTP/1.1"), 1u);
  EXPECT_NE(answer.find("Connection: close"), std::string::npos);
}

TEST(Framing, RequestsSentTogetherAreAnsweredInOrder) {
  const auto answer =
      exchange(get_text() + post_text("Content-Length: 2\r\n", "{}") + get_text(closing));
  EXPECT_EQ(count(answer, "HTTP/1.1 200"), 3u);
  EXPECT_LT(answer.find("ok\n"), answer.find("wavelengths_nm"));
  EXPECT_LT(answer.find("wavelengths_nm"), answer.rfind("ok\n"));
}

TEST(Framing, HttpOneZeroIsClosedUnlessAskedOtherwise) {
  const auto answer = exchange("GET /healthz HTTP/1.0\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_NE(answer.find("Connection: close"), std::string::npos);
}

TEST(Framing, AnAbsoluteAddressIsUnderstood) {
  EXPECT_EQ(status_of(exchange(get_text(closing, "http://here/healthz"))), 200);
}

TEST(Framing, RequestIdsAreEchoedOnlyWhenHarmless) {
  EXPECT_NE(
      exchange(get_text("X-Request-Id: Ab-1_z\r\n" + closing)).find("X-Request-Id: Ab-1_z\r\n"),
      std::string::npos);
  for (const auto& id : {std::string("a%0d%0aX-Evil: 1"), std::string("a b"), std::string("\""),
                         std::string(65, 'a')}) {
    const auto answer = exchange(get_text("X-Request-Id: " + id + "\r\n" + closing));
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_EQ(answer.find("X-Evil"), std::string::npos);
    EXPECT_EQ(answer.find("X-Request-Id: " + id + "\r\n"), std::string::npos);
  }
}

TEST(Framing, AnswersSayWhenTheyWereMade) {
  const std::time_t before = std::time(nullptr);
  for (const auto& asked : {get_text(closing), std::string("GET /healthz\r\n\r\n")}) {
    const auto answer = exchange(asked);
    const auto at = answer.find("\r\nDate: ");
    ASSERT_NE(at, std::string::npos) << answer;
    const std::string date = answer.substr(at + 8, answer.find("\r\n", at + 2) - at - 8);
    EXPECT_THAT(date, ::testing::MatchesRegex(
                          "[A-Z][a-z][a-z], [0-9][0-9] [A-Z][a-z][a-z] [0-9]+ [0-9:]+ GMT"));
    std::tm utc{};
    ASSERT_NE(strptime(date.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &utc), nullptr) << date;
    EXPECT_GE(timegm(&utc), before);
    EXPECT_LE(timegm(&utc), std::time(nullptr));
  }
}

TEST(Framing, RangesAreIgnored) {
  const auto answer = exchange(get_text("Range: bytes=0-0,1-1\r\n" + closing));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_TRUE(answer.ends_with("ok\n"));
}

TEST(Framing, AnswersAreNeverCompressed) {
  const auto answer =
      exchange(get_text("Accept-Encoding: gzip, br\r\n" + closing, "/v1/methods"));
  EXPECT_EQ(answer.find("Content-Encoding"), std::string::npos);
}

TEST(Connections, AKeptConnectionAnswersThousandsOfRequestsAtOnce) {
  RawClient raw;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 2000; ++i) {
    raw.send(get_text());
    ASSERT_EQ(status_of(raw.receive_one()), 200) << i;
  }
  // Without TCP_NODELAY each would take 40 ms.
  EXPECT_LT((std::chrono::steady_clock::now() - start) / 2000, 5ms);
}

TEST(Connections, IdleAndDrippingClientsBlockNobody) {
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 100; ++i) {
    idle.push_back(std::make_unique<RawClient>());
    if (i % 2 == 0) idle.back()->send("GET /hea");
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(status_of(exchange(get_text(closing))), 200);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 400ms);
}

/// Whether so many bytes are, by a reader that takes some of them every 5 ms.
bool is_taken(std::size_t bytes, std::size_t bytes_at_once) {
  int pair[2];
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair), 0);
  std::thread reader([&] {
    std::string chunk(bytes_at_once, ' ');
    while (::recv(pair[1], chunk.data(), chunk.size(), 0) > 0) std::this_thread::sleep_for(5ms);
  });
  ConnectionLimits limits;
  limits.write = 1s;
  limits.least_bytes_per_s = std::size_t{16} << 20;
  const bool taken = Connection(pair[0], -1, limits).write(std::string(bytes, 'x'));
  ::shutdown(pair[0], SHUT_WR);
  reader.join();
  for (const int each : pair) ::close(each);
  return taken;
}

TEST(Connections, WhoDripsIsGivenUpThoughItTakesBytesAllTheTime) {
  constexpr std::size_t mib = std::size_t{1} << 20;
  EXPECT_TRUE(is_taken(4 * mib, mib));
  EXPECT_FALSE(is_taken(4 * mib, mib / 128));
}

/// The buffers on the way must not hide that it takes bytes.
TEST(Connections, WhoReadsSlowlyButSteadilyIsAnsweredToTheEnd) {
  HttpServer::Options options;
  options.limits.write = 1500ms;
  options.limits.least_bytes_per_s = 65536;
  const std::string body(std::size_t{8} << 20, 'x');
  HttpServer server(options, {.answer = [&](const Request&) { return Answer{.body = body}; },
                              .refuse = [](const auto&, const auto&) { return Answer{}; }});
  server.bind("127.0.0.1:0");
  std::thread thread([&] { server.run(); });
  RawClient reader(server.port());
  reader.send(get_text(closing));
  std::size_t taken = 0;
  const auto take = [&](std::size_t bytes) {
    const auto got = reader.sip(bytes).size();
    taken += got;
    return got;
  };
  for (int i = 0; i < 80; ++i) {
    take(8192);
    std::this_thread::sleep_for(50ms);
  }
  while (take(65536) > 0) continue;
  EXPECT_GT(taken, body.size());
  server.stop();
  thread.join();
}

TEST(Connections, APortIsNotShared) {
  Config config = free_port();
  config.listen = "127.0.0.1:" + std::to_string(shared_daemon().port());
  EXPECT_THROW(Daemon{config}, std::runtime_error);
}

TEST(Connections, StoppingBeforeListeningIsNotLost) {
  Daemon never_started(free_port());
  never_started.stop();
  Daemon daemon(free_port());
  daemon.start();
  daemon.stop();
  EXPECT_FALSE(daemon.failed());
}

}  // namespace
}  // namespace cyanometer::testing
