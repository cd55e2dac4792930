// Contract of devices with the force loop: reading and commanding allocate nothing.
#include <cstdlib>
#include <memory>
#include <new>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/haply.h>
#include <firstcontact/haptic_devices/load_device_plugin.h>
#include <firstcontact/haptic_devices/recorded_device.h>
#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_devices/space_mouse.h>

#include "haptic_devices/fake_haply_service.h"
#include "haptic_devices/spacenav_records.h"

namespace {

thread_local bool counting = false;
thread_local int allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  allocations += counting ? 1 : 0;
  // Sizes of aligned_alloc are multiples of the alignment.
  void* memory =
      alignment <= alignof(std::max_align_t)
          ? std::malloc(size == 0 ? 1 : size)
          : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  allocations += counting ? 1 : 0;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace firstcontact {
namespace {

/// How often a force loop of some ticks allocates.
int allocations_of(Device& device, std::int64_t begin_ns) {
  allocations = 0;
  counting = true;
  for (std::int64_t tick = 0; tick < 200; ++tick) {
    const std::int64_t now_ns = begin_ns + 250'000 * tick;
    const DeviceState state = device.read(now_ns);
    device.command({state.X_DH.position * -100.0, {0.0, 0.0, 0.01}}, now_ns);
  }
  counting = false;
  return allocations;
}

TEST(ForceLoop, IsCountedByThisProgram) {
  counting = true;
  allocations = 0;
  const auto memory = std::make_unique<std::array<double, 100>>();
  counting = false;
  EXPECT_EQ(allocations, 1);
}

TEST(ForceLoop, AllocatesNothingInRecordings) {
  Recording recording;
  for (int i = 0; i < 100; ++i) {
    DeviceState sample;
    sample.time_ns = 300'000 * i;
    sample.status = DeviceStatus::live;
    recording.samples.push_back(sample);
  }
  RecordedDevice device(recording);
  EXPECT_EQ(allocations_of(device, 0), 0);
}

TEST(ForceLoop, AllocatesNothingInTheSimulatedOperator) {
  SimulatedOperatorOptions options;
  options.path = random_via_points({.seed = 1, .count = 5});
  options.channel.sensor_delay_ns = 500'000;
  options.channel.jitter_ns = 100'000;
  SimulatedOperator device(options);
  EXPECT_EQ(allocations_of(device, 0), 0);
}

TEST(ForceLoop, AllocatesNothingInPlugins) {
  const auto device = load_device_plugin(PLUGIN_ORBIT);
  EXPECT_EQ(allocations_of(*device, 0), 0);
}

TEST(ForceLoop, AllocatesNothingInTheSpaceMouse) {
  const test::TemporaryFolder folder;
  const auto listener = test::listen_local(folder.file("spnav.sock"));
  SpaceMouseOptions options;
  options.socket = folder.file("spnav.sock");
  SpaceMouse device(options);
  const auto daemon = test::accept_one(listener);
  test::send_bytes(daemon, test::agreed_protocol() + test::motion({100, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(
      test::eventually([&] { return device.read(steady_now_ns()).status == DeviceStatus::live; }));
  EXPECT_EQ(allocations_of(device, steady_now_ns()), 0);
}

TEST(ForceLoop, AllocatesNothingInHaply) {
  test::FakeHaplyService service(test::kInventorySince35);
  service.set_answer(test::haply_state("049D", 0.01));
  HaplyOptions options;
  options.host = "127.0.0.1";
  options.port = service.port();
  options.connect_ns = 20'000'000'000;
  Haply device(options);
  EXPECT_EQ(allocations_of(device, steady_now_ns()), 0);
}

}  // namespace
}  // namespace firstcontact
