#include "server/process_use.h"

#include <unistd.h>

#include <ctime>
#include <fstream>

namespace cyanometer {
namespace {

double cpu_seconds_so_far() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

double resident_bytes_now() {
  double all_pages = 0, resident_pages = 0;
  std::ifstream("/proc/self/statm") >> all_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

ProcessUse process_use() { return {cpu_seconds_so_far(), resident_bytes_now()}; }

}  // namespace cyanometer
