// Where threads are short: who makes room, and who does not.
#include "server/http/lobby.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <latch>
#include <memory>
#include <set>
#include <thread>

#include "server/http/http_server.h"
#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;

/// A guest of a lobby, and its client.
struct Visit {
  Visit(Lobby& lobby, const std::string& address) {
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair), 0);
    guest.emplace(lobby, pair[0], address);
    guest->enter();
  }
  ~Visit() {
    guest.reset();
    for (const int each : pair) ::close(each);
  }
  void send() const { EXPECT_EQ(::send(pair[1], "x", 1, 0), 1); }
  bool stays() { return guest->leave(); }

  int pair[2];
  std::optional<Lobby::Guest> guest;
};

TEST(Lobby, WhoHasWaitedLongestIsSentAway) {
  Lobby lobby;
  Visit first(lobby, "b"), second(lobby, "a"), third(lobby, "c");
  EXPECT_TRUE(lobby.send_one_away());
  EXPECT_FALSE(first.stays());
  EXPECT_TRUE(lobby.send_one_away());
  EXPECT_FALSE(second.stays());
  EXPECT_TRUE(third.stays());
  EXPECT_FALSE(lobby.send_one_away()) << "nobody is left";
}

TEST(Lobby, OfTheAddressThatHasMost) {
  Lobby lobby;
  Visit oldest(lobby, "a"), second(lobby, "b"), third(lobby, "b");
  EXPECT_TRUE(lobby.send_one_away());
  EXPECT_FALSE(second.stays());
  EXPECT_TRUE(oldest.stays());
  EXPECT_TRUE(third.stays());
}

TEST(Lobby, ButNobodyWhoseBytesHaveNotBeenRead) {
  Lobby lobby;
  Visit first(lobby, "a"), second(lobby, "a");
  first.send();
  EXPECT_TRUE(lobby.send_one_away());
  EXPECT_FALSE(second.stays());
  EXPECT_FALSE(lobby.send_one_away());
  EXPECT_TRUE(first.stays());
}

TEST(Lobby, NobodyIsSentAwayTwice) {
  Lobby lobby;
  Visit visit(lobby, "a");
  EXPECT_TRUE(lobby.send_one_away());
  visit.guest->enter();
  EXPECT_FALSE(lobby.send_one_away()) << "its one thread is promised already";
  EXPECT_FALSE(visit.stays());
}

/// A server of so many threads; what it is asked for as "/held" it answers when it is let go.
class Small {
 public:
  explicit Small(std::size_t threads)
      : server_({.limits = {}, .connections = threads},
                {.answer =
                     [this](const Request& request) {
                       if (request.path == "/held") {
                         ++held_;
                         release_.wait();
                       }
                       return Answer{.body = "done\n"};
                     },
                 .refuse =
                     [](const HttpProblem& problem, const std::string&) {
                       return Answer{
                           .status = problem.status,
                           .headers = {{"Retry-After", std::to_string(problem.retry_after_s)}}};
                     }}) {
    server_.bind("127.0.0.1:0");
    thread_ = std::thread([this] { server_.run(); });
  }
  ~Small() {
    let_go();
    server_.stop();
    thread_.join();
  }
  void let_go() {
    if (!release_.try_wait()) release_.count_down();
  }
  int port() const { return server_.port(); }
  int held() const { return held_; }
  int connections() const { return server_.connections(); }
  /// The status that a newcomer is told.
  int ask(const std::string& from = "127.0.0.1") const {
    RawClient raw(port(), from);
    raw.send("GET / HTTP/1.1\r\nHost: h\r\nConnection: close\r\n\r\n");
    return status_of(raw.receive());
  }

 private:
  std::latch release_{1};
  std::atomic<int> held_ = 0;
  HttpServer server_;
  std::thread thread_;
};

const std::string half_a_request =
    "POST / HTTP/1.1\r\nHost: h\r\nConnection: close\r\nContent-Length: 2\r\n\r\n{";

/// Clients that have come one after the other and sent so much, which has been read.
std::vector<std::unique_ptr<RawClient>> senders(const Small& server, int count,
                                                const std::string& bytes,
                                                const std::string& from = "127.0.0.1") {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < count; ++i) {
    const int before = server.connections();
    clients.push_back(std::make_unique<RawClient>(server.port(), from));
    clients.back()->send(bytes);
    while (server.connections() == before) std::this_thread::sleep_for(1ms);
  }
  std::this_thread::sleep_for(100ms);
  return clients;
}

TEST(ShortOfThreads, HalfSentBodiesMakeRoomAndAreTold) {
  Small server(3);
  const auto half = senders(server, 3, half_a_request);
  EXPECT_EQ(server.ask(), 200);
  const auto told = half[0]->receive();
  EXPECT_EQ(status_of(told), 503);
  EXPECT_THAT(told, ::testing::HasSubstr("Retry-After: 1"));
  for (const std::size_t i : {1u, 2u}) {
    half[i]->send("}");
    EXPECT_EQ(status_of(half[i]->receive()), 200) << "no more than needed are told";
  }
}

TEST(ShortOfThreads, HowManyEverTheyAre) {
  Small server(4);
  std::vector<std::unique_ptr<RawClient>> half;
  for (int i = 0; i < 100; ++i) {
    half.push_back(std::make_unique<RawClient>(server.port()));
    half.back()->send(half_a_request);
    if (i % 10 != 9) continue;
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(server.ask(), 200) << i;
  }
}

TEST(ShortOfThreads, OneAddressDoesNotTakeThemFromAnother) {
  Small server(4);
  const auto other = senders(server, 1, half_a_request);
  std::vector<std::unique_ptr<RawClient>> crowd =
      senders(server, 3, half_a_request, "127.0.0.2");
  for (int i = 0; i < 20; ++i) {
    crowd.push_back(std::make_unique<RawClient>(server.port(), "127.0.0.2"));
    crowd.back()->send(half_a_request);
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(server.ask("127.0.0.3"), 200);
  other[0]->send("}");
  EXPECT_EQ(status_of(other[0]->receive()), 200);
}

TEST(ShortOfThreads, IdleOnesMakeRoomWithoutAWord) {
  Small server(2);
  const std::string ask = "GET / HTTP/1.1\r\nHost: h\r\n\r\n";
  const auto idle = senders(server, 2, ask);
  for (const auto& each : idle) EXPECT_EQ(status_of(each->receive_one()), 200);
  EXPECT_EQ(server.ask(), 200);
  std::multiset<int> statuses;  // which of them came back to wait first is not known
  for (const auto& each : idle) {
    each->send(ask);
    statuses.insert(status_of(each->receive_one()));
  }
  EXPECT_EQ(statuses, (std::multiset{0, 200}));
}

TEST(ShortOfThreads, WhoIsBeingAnsweredIsNotLetGo) {
  Small server(2);
  const auto held =
      senders(server, 2, "GET /held HTTP/1.1\r\nHost: h\r\nConnection: close\r\n\r\n");
  ASSERT_EQ(server.held(), 2);
  EXPECT_EQ(server.ask(), 503);
  server.let_go();
  for (const auto& each : held) EXPECT_EQ(status_of(each->receive()), 200);
  EXPECT_EQ(server.ask(), 200) << "those who were answered and do not close make room";
}

}  // namespace
}  // namespace cyanometer::testing
