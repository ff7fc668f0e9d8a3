#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <thread>
#include <utility>

#include "engine/engine.h"
#include "engine/vulkan/buffer_pool.h"
#include "engine/vulkan/commands.h"
#include "spirv/combine.spv.h"
#include "spirv/texels.spv.h"

namespace cyanometer::vulkan {
namespace {

using testing::Each;
using testing::HasSubstr;

constexpr std::uint32_t kCount = 1000;
struct Push {
  std::uint32_t count = kCount;
  std::uint32_t shift = 0;
};
constexpr Groups kGroups{groups_for(kCount, 64)};

/// c[i] = a[(i + shift) mod count] + factor b[i], factor being constant 0.
class Combine : public testing::Test {
 protected:
  Combine() {
    std::iota(a.as<std::uint32_t>().begin(), a.as<std::uint32_t>().end(), 0u);
    std::ranges::fill(b.as<std::uint32_t>(), 7u);
  }
  Buffer make_buffer() { return {device, kCount * sizeof(std::uint32_t), Memory::host}; }
  void run(const Specialization& specialization, Push push) {
    commands.dispatch(kernel, specialization, {a, b, c}, bytes_of(push), kGroups);
    commands.submit_and_wait();
  }
  std::uint32_t result(std::size_t i) const { return c.as<std::uint32_t>()[i]; }

  Device device;
  Kernel kernel{device, combine_spirv, 3, sizeof(Push)};
  Buffer a = make_buffer(), b = make_buffer(), c = make_buffer();
  /// With one binding more, for kernels of the same code share their pipelines.
  Kernel make_other() { return {device, combine_spirv, 4, sizeof(Push)}; }
  Commands commands{device};
};

template <typename Thrown, typename Work>
std::string message_of(Work work) {
  try {
    work();
  } catch (const Thrown& thrown) {
    return thrown.what();
  }
  ADD_FAILURE() << "nothing of that type was thrown";
  return "";
}

TEST(Devices, TheOneTakenIsTheFirstUsableOneListed) {
  const Device taken;
  std::vector<DeviceInfo> devices = list();
  std::erase_if(devices, [](const DeviceInfo& info) { return !info.usable; });
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(taken.info().id, devices.front().id);
}

TEST(Devices, ANameThatNoneHasIsRefusedNamingItAndWhatThereIs) {
  const std::string message = message_of<NoDevice>([] { Device("no such device"); });
  EXPECT_THAT(message, HasSubstr("no such device"));
  for (const DeviceInfo& info : list()) EXPECT_THAT(message, HasSubstr(info.name));
}

TEST(Devices, AreFoundByAPartOfTheirNameInAnyCase) {
  const std::string name = list().front().name;
  std::string part = name.substr(0, name.size() / 2);
  for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_THAT(Device(part).info().name, HasSubstr(name.substr(0, name.size() / 2)));
}

TEST_F(Combine, AddsExactly) {
  run({1}, {});
  for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(result(i), i + 7) << i;
}

TEST_F(Combine, EachSpecializationIsAPipelineOfItsOwn) {
  for (const std::uint32_t factor : {2u, 100u, 2u}) {
    run({factor}, {});
    EXPECT_EQ(result(5), 5 + factor * 7);
  }
  run({}, {});
  EXPECT_EQ(result(5), 5 + 7u) << "without constants the shader's own defaults hold";
}

TEST_F(Combine, ConstantsThatTheCodeLacksMakeNoPipelines) {
  for (const std::uint32_t idle : {0u, 1u, 2u}) {
    run({3, idle}, {});
    EXPECT_EQ(result(5), 5 + 3u * 7);
  }
  run({3}, {});
  EXPECT_EQ(device.pipelines().made, 1u);
  run({4, 2}, {});
  EXPECT_EQ(result(5), 5 + 4u * 7);
  EXPECT_EQ(device.pipelines().made, 2u);
}

TEST(Texels, OfEveryKindAreReadAndWrittenAtTheOffsetsOfTheirBindings) {
  Device device;
  Commands commands(device);
  const Kernel kernel(device, texels_spirv, 5);
  constexpr std::size_t count = 64;
  const std::size_t offset = device.limits().storage_alignment;
  auto make = [&](std::size_t texel_bytes) {
    return Buffer(device, offset + count * texel_bytes, Memory::host);
  };
  Buffer table = make(16), values = make(4), pairs = make(16), plain = make(4), sum = make(4);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<std::uint32_t>(i);
    const std::array<float, 4> texel{-1, -1, -1, static_cast<float>(1000 * i)};
    const float value = static_cast<float>(i) + 0.5f;
    const std::array<std::uint32_t, 4> pair{~0u, 1u << 20, ~0u, ~0u};
    table.write(offset + 16 * i, bytes_of(texel));
    values.write(offset + 4 * i, bytes_of(value));
    pairs.write(offset + 16 * i, bytes_of(pair));
    plain.write(offset + 4 * i, bytes_of(n));
    sum.write(offset + 4 * i, bytes_of(n));
  }
  const auto at = [&](const Buffer& buffer) { return Binding(buffer, offset); };
  for (int times = 1; times <= 2; ++times) {
    commands.dispatch(kernel, {}, {at(table), at(values), at(pairs), at(plain), at(sum)}, {},
                      {1});
    commands.submit_and_wait();
    for (std::uint32_t i = 0; i < count; ++i)
      ASSERT_EQ(sum.as<std::uint32_t>()[offset / 4 + i],
                i + static_cast<std::uint32_t>(times) * (1000 * i + i + (1u << 20) + i));
  }
}

TEST_F(Combine, MoreSpecializationsThanAreKeptStillRun) {
  device.keep_pipelines(8);
  for (std::uint32_t factor = 0; factor < 100; ++factor)
    commands.dispatch(kernel, {factor}, {a, b, c}, bytes_of(Push{64, 0}), {});
  commands.submit_and_wait();
  EXPECT_EQ(result(5), 5 + 99u * 7);
  EXPECT_EQ(device.pipelines().kept, 8u);
  EXPECT_EQ(device.pipelines().made, 100u);
}

TEST_F(Combine, OfAllKernelsPipelinesThoseUsedLastAreKept) {
  device.keep_pipelines(3);
  const Kernel other = make_other();
  const auto made_by = [&](const Kernel& one, std::uint32_t factor) {
    const auto before = device.pipelines().made;
    const std::vector<Binding> bindings{a, b, c, c};
    commands.dispatch(one, {factor}, std::span(bindings).first(&one == &other ? 4 : 3),
                      bytes_of(Push{}), kGroups);
    commands.submit_and_wait();
    EXPECT_EQ(result(5), 5 + factor * 7);
    EXPECT_LE(device.pipelines().kept, 3u);
    return device.pipelines().made - before;
  };
  EXPECT_EQ(made_by(kernel, 1), 1u);
  EXPECT_EQ(made_by(other, 1), 1u);
  EXPECT_EQ(made_by(kernel, 2), 1u);
  EXPECT_EQ(made_by(kernel, 1), 0u) << "it is kept";
  EXPECT_EQ(made_by(kernel, 3), 1u) << "the other kernel's has to go";
  EXPECT_EQ(made_by(kernel, 1), 0u);
  EXPECT_EQ(made_by(kernel, 2), 0u);
  EXPECT_EQ(made_by(other, 1), 1u) << "it went";
  device.keep_pipelines(1);
  EXPECT_EQ(device.pipelines().kept, 1u);
  EXPECT_EQ(made_by(other, 1), 0u);
}

TEST_F(Combine, AKernelThatGoesTakesItsPipelinesAlong) {
  run({1}, {});
  {
    const Kernel other = make_other();
    commands.dispatch(other, {2}, {a, b, c, c}, bytes_of(Push{}), kGroups);
    commands.submit_and_wait();
    EXPECT_EQ(device.pipelines().kept, 2u);
  }
  EXPECT_EQ(device.pipelines().kept, 1u);
  device.keep_pipelines(1);
  run({3}, {});
  EXPECT_EQ(result(5), 5 + 3u * 7);
}

TEST_F(Combine, KernelsOfTheSameCodeShareTheirPipelines) {
  run({3}, {});
  const Kernel same(device, std::vector(std::begin(combine_spirv), std::end(combine_spirv)), 3,
                    sizeof(Push));
  commands.dispatch(same, {3}, {a, b, c}, bytes_of(Push{kCount, 10}), kGroups);
  commands.submit_and_wait();
  EXPECT_EQ(result(0), 10 + 3 * 7u);
  EXPECT_EQ(device.pipelines().made, 1u);
}

TEST_F(Combine, WorkThatIsForgottenLeavesItsPipelines) {
  std::ranges::fill(c.as<std::uint32_t>(), 99u);
  commands.dispatch(kernel, {4}, {a, b, c}, bytes_of(Push{}), kGroups);
  commands.begin();
  commands.submit_and_wait();
  EXPECT_EQ(result(5), 99u) << "it was not done";
  run({4}, {});
  EXPECT_EQ(result(5), 5 + 4 * 7u);
  EXPECT_EQ(device.pipelines().made, 1u);
}

TEST_F(Combine, PushConstantsReachTheShader) {
  run({0}, {kCount, 10});
  EXPECT_EQ(result(0), 10u);
  EXPECT_EQ(result(kCount - 1), 9u);
  run({0}, {1, 0});
  EXPECT_EQ(result(0), 0u);
  EXPECT_EQ(result(1), 11u) << "beyond the new count nothing is written";
}

TEST_F(Combine, EachStepSeesWhatTheStepBeforeItWrote) {
  Buffer ones = make_buffer();
  std::ranges::fill(a.as<std::uint32_t>(), 0u);
  commands.fill(ones, 1);
  constexpr std::uint32_t kRounds = 100;
  for (std::uint32_t i = 0; i < kRounds; ++i) {
    commands.dispatch(kernel, {1}, {a, ones, c}, bytes_of(Push{kCount, 501}), kGroups);
    commands.dispatch(kernel, {1}, {c, ones, a}, bytes_of(Push{kCount, 499}), kGroups);
  }
  commands.copy(a, c);
  commands.submit_and_wait();
  EXPECT_THAT(c.as<std::uint32_t>(), Each(2 * kRounds));
}

TEST_F(Combine, BindsPartsOfBuffers) {
  const std::size_t part = device.limits().storage_alignment * 4;
  const std::uint32_t first = static_cast<std::uint32_t>(part / 4);
  commands.dispatch(kernel, {1}, {Binding(a, part, 4), Binding(b, 0, 4), Binding(c, part, 4)},
                    bytes_of(Push{1, 0}), {});
  commands.submit_and_wait();
  EXPECT_EQ(result(first), first + 7);
}

TEST_F(Combine, WhatDoesNotFitTheKernelIsRefused) {
  const auto dispatch = [&](std::span<const Binding> bindings, std::span<const std::byte> push,
                            Groups groups) {
    return message_of<std::invalid_argument>(
        [&] { commands.dispatch(kernel, {1}, bindings, push, groups); });
  };
  const Push push;
  const Binding two[] = {a, b};
  const Binding odd[] = {a, b, {c, 1}};
  const Binding beyond[] = {a, b, {c, 0, c.size() + 4}};
  const Binding all[] = {a, b, c};
  EXPECT_THAT(dispatch(two, bytes_of(push), {}), HasSubstr("given 2"));
  EXPECT_THAT(dispatch(odd, bytes_of(push), {}), HasSubstr("multiples of"));
  EXPECT_THAT(dispatch(beyond, bytes_of(push), {}), HasSubstr("4004 bytes"));
  EXPECT_THAT(dispatch(all, bytes_of(push.count), {}), HasSubstr("given 4"));
  EXPECT_THAT(dispatch(all, bytes_of(push), {.y = 0}), HasSubstr("0 groups along y"));
}

TEST_F(Combine, ABindingOverTheDevicesRangeIsRefused) {
  const std::size_t range = device.limits().max_storage_range;
  if (range >= std::size_t{1} << 30) GTEST_SKIP() << "the range is as large as memory may be";
  const Buffer large(device, range + 256, Memory::device);
  EXPECT_THAT(message_of<std::invalid_argument>([&] {
                commands.dispatch(kernel, {1}, {large, b, c}, bytes_of(Push{}), {});
              }),
              HasSubstr("at most " + std::to_string(range)));
  EXPECT_NO_THROW(
      commands.dispatch(kernel, {1}, {Binding(large, 256), b, c}, bytes_of(Push{}), {}));
}

TEST(Kernels, WithMoreBindingsOrPushConstantsThanTheDeviceAllowsAreRefused) {
  Device device;
  const Limits& limits = device.limits();
  EXPECT_THROW(Kernel(device, combine_spirv, limits.max_bindings + 1), std::invalid_argument);
  EXPECT_THROW(Kernel(device, combine_spirv, 3, limits.max_push_bytes + 4),
               std::invalid_argument);
}

TEST_F(Combine, WorkTakesTimeOnTheDevice) {
  for (int i = 0; i < 1000; ++i)
    commands.dispatch(kernel, {1}, {a, b, c}, bytes_of(Push{}), kGroups);
  const auto start = std::chrono::steady_clock::now();
  const double device_ms = commands.submit_and_wait();
  const std::chrono::duration<double, std::milli> wall =
      std::chrono::steady_clock::now() - start;
  EXPECT_GT(device_ms, 0);
  EXPECT_LE(device_ms, wall.count() * 1.1);
}

TEST_F(Combine, WhatIsRecordedOutlivesItsBuffersAndKernel) {
  {
    Buffer temporary = make_buffer();
    std::ranges::fill(temporary.as<std::uint32_t>(), 3u);
    const Kernel other(device, combine_spirv, 3, sizeof(Push));
    commands.dispatch(other, {1}, {temporary, b, c}, bytes_of(Push{}), kGroups);
  }
  commands.submit_and_wait();
  EXPECT_THAT(c.as<std::uint32_t>(), Each(10u));
}

TEST_F(Combine, BeginForgetsWhatWasNotSubmitted) {
  std::ranges::fill(c.as<std::uint32_t>(), 0u);
  commands.dispatch(kernel, {1}, {a, b, c}, bytes_of(Push{}), kGroups);
  commands.begin();
  commands.submit_and_wait();
  EXPECT_THAT(c.as<std::uint32_t>(), Each(0u));
}

TEST_F(Combine, WorkWhosePipelineCannotBeMadeFailsAloneAndIsForgotten) {
  if (std::getenv("CYANOMETER_VALIDATION")) GTEST_SKIP() << "the layer objects to such code";
  if (device.info().type != "cpu") GTEST_SKIP() << "drivers may do anything with such code";
  std::vector<std::uint32_t> code(std::begin(combine_spirv), std::end(combine_spirv));
  constexpr std::uint32_t main_in_ascii = 0x6e69616d;
  std::ranges::replace(code, main_in_ascii, main_in_ascii + 1);
  const Kernel without_entry(device, code, 3, sizeof(Push));
  for (int i = 0; i < 2; ++i) {
    commands.dispatch(without_entry, {1}, {a, b, c}, bytes_of(Push{}), kGroups);
    EXPECT_THROW(commands.submit_and_wait(), Error);
    EXPECT_EQ(device.pipelines().kept, 0u);
  }
  run({4}, {});
  EXPECT_EQ(result(5), 5 + 4 * 7u);
}

TEST(Buffers, ReadBackWhatWasWritten) {
  Device device;
  for (const Memory memory : {Memory::host, Memory::device}) {
    Buffer buffer(device, 16, memory);
    const std::uint64_t written = 0x0123456789abcdef;
    std::uint64_t read = 0;
    buffer.write(8, bytes_of(written));
    buffer.read(8, std::as_writable_bytes(std::span(&read, 1)));
    EXPECT_EQ(read, written);
    EXPECT_THROW(buffer.write(9, bytes_of(written)), std::out_of_range);
    EXPECT_THROW(buffer.write(~std::size_t{0}, bytes_of(written)), std::out_of_range);
  }
}

TEST(Buffers, OfNoBytesOrOfMoreThanThereIsAreRefused) {
  Device device;
  EXPECT_THROW(Buffer(device, 0, Memory::host), std::invalid_argument);
  const std::size_t bytes = std::size_t{1} << 50;
  EXPECT_THAT(message_of<OutOfMemory>([&] { Buffer(device, bytes, Memory::host); }),
              HasSubstr(std::to_string(bytes)));
}

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(BufferPools, HandOutWhatWasGivenBack) {
  Device device("");
  BufferPool pool(device, 8 << 20);
  auto buffer = pool.take(1 << 20, Memory::host);
  const void* memory = buffer->mapped();
  EXPECT_GE(buffer->size(), std::size_t{1} << 20);
  const auto other = pool.take(1 << 20, Memory::host);
  EXPECT_NE(other->mapped(), memory);
  buffer.reset();
  EXPECT_EQ(pool.take((1 << 20) - 100, Memory::host)->mapped(), memory);
  const std::size_t in_use = device.allocated_bytes();
  pool.clear();
  EXPECT_LT(device.allocated_bytes(), in_use);
}

TEST(BufferPools, KeepNoMoreThanTheyMay) {
  Device device("");
  const std::size_t before = device.allocated_bytes();
  BufferPool pool(device, 8 << 20);
  {
    std::vector<std::shared_ptr<const Buffer>> many;
    for (int i = 0; i < 6; ++i) many.push_back(pool.take(2 << 20, Memory::host));
  }
  EXPECT_LE(device.allocated_bytes() - before, std::size_t{8} << 20);
  EXPECT_GE(device.allocated_bytes() - before, std::size_t{6} << 20);
  pool.take(16 << 20, Memory::host);
  EXPECT_LE(device.allocated_bytes() - before, std::size_t{8} << 20);
}

TEST(BufferPools, MayEndBeforeTheirBuffers) {
  Device device("");
  const std::size_t before = device.allocated_bytes();
  std::shared_ptr<const Buffer> buffer;
  {
    BufferPool pool(device, 8 << 20);
    buffer = pool.take(1 << 20, Memory::host);
  }
  std::ranges::fill(buffer->as<char>(), 'x');
  buffer.reset();
  EXPECT_EQ(device.allocated_bytes(), before);
}

TEST(BufferPools, GiveUpWhatIsIdleForWhatIsNeeded) {
  Device device("");
  BufferPool pool(device, 8 << 20);
  pool.take(4 << 20, Memory::host).reset();
  device.limit_memory(device.allocated_bytes() + (1 << 20));
  EXPECT_NO_THROW(pool.take(3 << 20, Memory::host));
  EXPECT_THROW(pool.take(64 << 20, Memory::host), OutOfMemory);
}

TEST(Buffers, ThousandsOfThemLeaveNothingBehindOnWhicheverThreadTheyEnd) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer holds freed memory back, and looks for leaks itself";
#endif
  Device device;
  constexpr std::size_t kBytes = 1 << 20;
  const auto make_and_free = [&](int count) {
    for (int i = 0; i < count; ++i) {
      Buffer buffer(device, kBytes, Memory::host);
      std::ranges::fill(buffer.as<unsigned char>(), static_cast<unsigned char>(i));
      std::thread([moved = std::move(buffer)] {}).join();
    }
  };
  make_and_free(10);
  const std::size_t before = resident_bytes();
  make_and_free(2000);
  EXPECT_LT(resident_bytes(), before + 50 * kBytes);
}

TEST_F(Combine, ALostDeviceIsSaidToBeLostFromThenOn) {
  const auto submit = [&] {
    commands.dispatch(kernel, {1}, {a, b, c}, bytes_of(Push{}), kGroups);
    commands.submit_and_wait();
  };
  device.lose_at_submission(2);
  EXPECT_NO_THROW(submit());
  EXPECT_THROW(submit(), DeviceLost);
  EXPECT_THROW(submit(), DeviceLost);
  EXPECT_THROW(Commands(device).submit_and_wait(), DeviceLost);
  Device again;
  EXPECT_NO_THROW(Commands(again).submit_and_wait());
}

TEST_F(Combine, WorkThatIsNotDoneInTimeIsALostDeviceAndEndsWithoutHarm) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "what such work uses is never freed";
#endif
  for (int i = 0; i < 5000; ++i)
    commands.dispatch(kernel, {1}, {a, b, c}, bytes_of(Push{}), kGroups);
  commands.dispatch(kernel, {2}, {a, b, c}, bytes_of(Push{}), kGroups);
  EXPECT_THAT(
      message_of<DeviceLost>([&] { commands.submit_and_wait(std::chrono::nanoseconds(0)); }),
      HasSubstr("has not answered in"));
  EXPECT_THROW(commands.submit_and_wait(), DeviceLost);
  const volatile std::uint32_t& last = c.as<std::uint32_t>().back();
  while (last != kCount - 1 + 2 * 7) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

/// The validation layer watches the devices made while this lives.
class Validated : public testing::Test {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the layer itself leaks";
#endif
    setenv("CYANOMETER_VALIDATION", "1", 1);
  }
  void TearDown() override { unsetenv("CYANOMETER_VALIDATION"); }
};

TEST_F(Validated, TheLayerFindsNothingInAllThatTheseClassesDo) {
  Device device;
  const Kernel kernel(device, combine_spirv, 3, sizeof(Push));
  Buffer a(device, 4096, Memory::host), b(device, 4096, Memory::device),
      c(device, 4096, Memory::host);
  Commands commands(device);
  for (int round = 0; round < 3; ++round) {
    commands.fill(a, 1);
    commands.copy(a, b);
    for (const std::uint32_t factor : {1u, 2u})
      commands.dispatch(kernel, {factor}, {a, b, c}, bytes_of(Push{}), kGroups);
    commands.copy(c, b);
    commands.submit_and_wait();
  }
  EXPECT_EQ(c.as<std::uint32_t>()[0], 3u);
  EXPECT_EQ(device.validation_messages(), 0);
}

TEST_F(Validated, StepsCalledIndependentThatAreNotAreFound) {
  // The objections are kept here: tests/validation looks for those that nobody expects.
  testing::internal::CaptureStderr();
  Device device;
  const Kernel kernel(device, combine_spirv, 3, sizeof(Push));
  const Buffer a(device, 4096, Memory::host), c(device, 4096, Memory::host);
  Commands commands(device);
  commands.dispatch(kernel, {1}, {a, a, c}, bytes_of(Push{}), kGroups);
  commands.dispatch(kernel, {1}, {c, c, a}, bytes_of(Push{}), kGroups, Order::independent);
  commands.submit_and_wait();
  EXPECT_GT(device.validation_messages(), 0);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("SYNC-HAZARD-"));
}

TEST_F(Validated, NothingIsLeftWhenTheDeviceGoes) {
  testing::internal::CaptureStderr();
  {
    Device device;
    const Kernel kernel(device, combine_spirv, 3, sizeof(Push));
    Buffer buffer(device, 4096, Memory::host);
    Commands commands(device);
    commands.dispatch(kernel, {1}, {buffer, buffer, buffer}, bytes_of(Push{1, 0}), {});
    commands.submit_and_wait();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace cyanometer::vulkan
