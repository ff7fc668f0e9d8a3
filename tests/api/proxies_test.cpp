// Who the client is behind a reverse proxy.
#include "server/http/proxies.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace cyanometer::testing {
namespace {

TEST(Proxies, WithoutAnyTheClientIsWhoConnects) {
  EXPECT_EQ(Proxies().client("192.0.2.1", "203.0.113.1"), "192.0.2.1");
  EXPECT_EQ(Proxies("").client("192.0.2.1", "203.0.113.1"), "192.0.2.1");
}

TEST(Proxies, AreBelievedWhereTheyAreNamed) {
  const Proxies proxies("192.0.2.1, 10.0.0.0/8,2001:db8::/32");
  for (const auto* peer : {"192.0.2.1", "10.255.0.9", "2001:db8:7::1", "::ffff:10.1.2.3"}) {
    EXPECT_EQ(proxies.client(peer, "203.0.113.1"), "203.0.113.1") << peer;
  }
  for (const auto* peer : {"192.0.2.2", "11.0.0.1", "2001:db9::1"}) {
    EXPECT_EQ(proxies.client(peer, "203.0.113.1"), peer);
  }
}

TEST(Proxies, TheClientIsTheLastThatIsNoProxy) {
  const Proxies proxies("10.0.0.0/8");
  EXPECT_EQ(proxies.client("10.0.0.1", "1.1.1.1, 203.0.113.1"), "203.0.113.1");
  EXPECT_EQ(proxies.client("10.0.0.1", "1.1.1.1,203.0.113.1 , 10.0.0.2"), "203.0.113.1");
  EXPECT_EQ(proxies.client("10.0.0.1", "10.0.0.3,10.0.0.2"), "10.0.0.3");
}

TEST(Proxies, WhatIsNoAddressIsNoClient) {
  const Proxies proxies("10.0.0.0/8");
  for (const auto* forwarded : {"", "unknown", "203.0.113.1:80", "203.0.113.1, ", "1.2.3"}) {
    EXPECT_EQ(proxies.client("10.0.0.1", forwarded), "10.0.0.1") << forwarded;
  }
  EXPECT_EQ(proxies.client("10.0.0.1", "203.0.113.1, _hidden, 10.0.0.2"), "10.0.0.2");
  EXPECT_EQ(proxies.client("unknown", "203.0.113.1"), "unknown");
}

TEST(Proxies, OneClientHasOneNameHoweverItIsWritten) {
  const Proxies proxies("10.0.0.0/8");
  EXPECT_EQ(proxies.client("10.0.0.1", "2001:DB8:0::1"), "2001:db8::1");
  EXPECT_EQ(proxies.client("10.0.0.1", "::ffff:203.0.113.1"), "203.0.113.1");
}

TEST(Proxies, TheirListIsReadStrictly) {
  for (const auto* list : {"here", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1", "10.0.0.0/8x",
                           "::1/129", "10.0.0.1,,10.0.0.2", "10.0.0.1:80"}) {
    EXPECT_THROW(Proxies{list}, std::runtime_error) << list;
  }
  EXPECT_EQ(Proxies("0.0.0.0/0").client("192.0.2.1", "203.0.113.1"), "203.0.113.1");
}

}  // namespace
}  // namespace cyanometer::testing
