// What makes the silence of the API's suite mean something.
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

namespace cyanometer::testing {
namespace {

void race() {
  int count = 0;
  std::thread other([&] { ++count; });
  ++count;
  other.join();
  std::exit(count == 0);
}

TEST(Races, AreFound) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr int of_thread_sanitizer = 66;
  EXPECT_EXIT(race(), ::testing::ExitedWithCode(of_thread_sanitizer), "data race");
}

}  // namespace
}  // namespace cyanometer::testing
