#include "device/drivers/plugin/plugin_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/drivers.hpp"
#include "device/drivers/plugin/plugin_library.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

namespace touchtrial::device {
namespace {

constexpr int kZerosAtTheEnd = 5;
/// How long a call may delay closing.
constexpr std::chrono::seconds kPluginTimeout{2};

/// \throws DeviceError if no plug-in is named, or loading its library crashes
const std::filesystem::path& expect_loadable(const std::filesystem::path& library) {
  if (library.empty()) {
    throw DeviceError(
        "plugin: no plug-in is named; name its library in the device settings at plugin.library");
  }
  check_loads(library, plugin::kRemedy);
  return library;
}

std::vector<DeviceListing> list_plugins(const DeviceSettings& settings) {
  DeviceListing listing;
  listing.driver = "plugin";
  listing.where = settings.plugin.library.string();
  try {
    const plugin::Library library(expect_loadable(settings.plugin.library));
    const DeviceInfo info = plugin::OpenDevice(library, settings.plugin.settings).info();
    listing.model = info.model;
    listing.serial = info.serial;
    listing.present = true;
  } catch (const DeviceError& error) {
    listing.missing = {error.what()};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> open_plugin(const DeviceSettings& settings) {
  (void)expect_loadable(settings.plugin.library);
  return std::make_unique<PluginDevice>(settings.plugin);
}

}  // namespace

/// The library, the device, and its thread's loop.
struct PluginDevice::Running {
  Running(const PluginSettings& settings, PluginOptions options)
      : library(settings.library),
        device(library, settings.settings),
        info(device.info()),
        pace(std::move(options.pace)),
        scheduling(options.scheduling),
        period(static_cast<std::int64_t>(1e9 / info.max_rate_hz)) {}

  /// The main function of the device's thread.
  void run() noexcept {
    (void)request_scheduling(scheduling);
    LinkPace::Time next = pace->now();
    while (!closing.load(std::memory_order_acquire)) {
      pace->rest_until(next);
      next = std::max(next + period, pace->now());  // no burst after a stall
      tick();
    }
    for (int i = 0; i < kZerosAtTheEnd; ++i) (void)device.force({});
    (void)device.enable(false);
    pace->end();
  }

  void tick() noexcept {
    if (link.fault() == DeviceFault::none) take_sample();
    const bool ready = readiness.load(std::memory_order_relaxed) == DeviceReadiness::ready;
    const std::optional<Vec3> live = ready ? link.live_force(pace->now()) : std::nullopt;
    enable(live.has_value());
    note(device.force(live.value_or(Vec3{})));
  }

  void take_sample() noexcept {
    const plugin::Reading reading = device.sample();
    note(reading.trouble);
    if (reading.trouble != plugin::PluginFault::none) return;
    readiness.store(reading.readiness, std::memory_order_release);
    if (reading.is_new) link.publish(reading.sample);
  }

  void enable(bool on) noexcept {
    if (on == enabled) return;
    enabled = on;
    note(device.enable(on));
  }

  void note(plugin::PluginFault found) noexcept {
    if (found == plugin::PluginFault::none) return;
    auto none = plugin::PluginFault::none;
    trouble.compare_exchange_strong(none, found, std::memory_order_acq_rel);
    link.fail(plugin::fault_of(found));
  }

  plugin::Library library;
  plugin::OpenDevice device;
  DeviceInfo info;
  std::unique_ptr<LinkPace> pace;
  SchedulingRequest scheduling;
  LinkPace::Time period;
  DeviceLink link;
  bool enabled = false;  ///< used only by the device's thread
  std::atomic<DeviceReadiness> readiness{DeviceReadiness::needs_calibration};
  std::atomic<plugin::PluginFault> trouble{plugin::PluginFault::none};
  std::atomic<bool> closing{false};
};

PluginDevice::PluginDevice(const PluginSettings& settings, PluginOptions options)
    : running_(std::make_shared<Running>(settings, std::move(options))) {
  std::packaged_task<void()> life([running = running_] { running->run(); });
  ended_ = life.get_future();
  thread_ = std::thread(std::move(life));
}

PluginDevice::~PluginDevice() {
  running_->link.halt();
  running_->closing.store(true, std::memory_order_release);
  running_->pace->end();
  if (ended_.wait_for(kPluginTimeout) == std::future_status::ready) {
    thread_.join();
  } else {
    thread_.detach();  // a call hangs; its thread closes the device if it ever returns
  }
}

DeviceInfo PluginDevice::info() const {
  return running_->info;
}

DeviceLink& PluginDevice::link() const noexcept {
  return running_->link;
}

DeviceLink::Time PluginDevice::link_time() const noexcept {
  return running_->pace->now();
}

DeviceReadiness PluginDevice::readiness() const noexcept {
  return running_->readiness.load(std::memory_order_acquire);
}

plugin::PluginFault PluginDevice::trouble() const noexcept {
  return running_->trouble.load(std::memory_order_acquire);
}

DeviceDriver plugin_driver() {
  return {.name = "plugin",
          .what = "a lab's own driver, a shared library with touchtrial_device.h's interface",
          .list = list_plugins,
          .open = open_plugin,
          .workspace_is_known = false};
}

}  // namespace touchtrial::device
