// How often tables are made.
#include "engine/methods/table_cache.h"

#include <gtest/gtest.h>

namespace cyanometer {
namespace {

struct Thousand final : Tables {
  std::size_t bytes() const override { return 1000; }
};

/// Counts what it makes.
struct Maker {
  std::shared_ptr<const Thousand> operator()() {
    ++made;
    return std::make_shared<Thousand>();
  }
  int made = 0;
};

TEST(TableCache, KeepsWhatItHasRoomForAndGivesUpWhatWasUsedLongestAgo) {
  TableCache cache(2500);
  Maker maker;
  auto get = [&](const char* key) { cache.get<Thousand>(key, std::ref(maker)); };
  get("a"), get("b"), get("a");
  EXPECT_EQ(maker.made, 2);
  get("c"), get("a");  // in the place of b
  EXPECT_EQ(maker.made, 3);
  get("b");
  EXPECT_EQ(maker.made, 4);
  EXPECT_EQ(cache.count(), 2);
}

TEST(TablesInUse, AreMadeOnceThoughTheCacheKeepsNone) {
  TableCache cache(10);
  Maker maker;
  TablesInUse frame(cache);
  auto first = frame.get<Thousand>("a", std::ref(maker));
  EXPECT_EQ(frame.get<Thousand>("a", std::ref(maker)), first);
  EXPECT_EQ(maker.made, 1);
  EXPECT_EQ(cache.count(), 0);
  frame.give_up();
  frame.get<Thousand>("a", std::ref(maker));
  EXPECT_EQ(maker.made, 2);
}

TEST(TablesInUse, DoNotHoldThoseThatTheyAreMadeOf) {
  TableCache cache(10);
  Maker sources;
  TablesInUse frame(cache);
  std::weak_ptr<const Thousand> source;
  frame.get<Thousand>("made", [&] {
    source = frame.get<Thousand>("source", std::ref(sources));
    return std::make_shared<const Thousand>();
  });
  EXPECT_TRUE(source.expired());
  EXPECT_THROW(
      frame.get<Thousand>("broken", [&]() -> std::shared_ptr<const Thousand> { throw 1; }),
      int);
  auto held = frame.get<Thousand>("source", std::ref(sources));
  EXPECT_EQ(held.use_count(), 2);
}

}  // namespace
}  // namespace cyanometer
