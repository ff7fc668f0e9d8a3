// The threads that wait for clients.
#include "server/http/thread_pool.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <future>

namespace cyanometer::testing {
namespace {

int nice_of_this_thread() { return ::getpriority(PRIO_PROCESS, 0); }

TEST(ThreadPool, ItsThreadsStandBackBehindTheOthersOfTheProcess) {
  const int here = nice_of_this_thread();
  for (const int nice : {0, 5}) {
    ThreadPool pool(1, nice);
    std::promise<int> there;
    EXPECT_TRUE(pool.start([&] { there.set_value(nice_of_this_thread()); }));
    EXPECT_EQ(there.get_future().get(), here + nice);
    pool.shutdown();
  }
  EXPECT_EQ(nice_of_this_thread(), here);
}

}  // namespace
}  // namespace cyanometer::testing
