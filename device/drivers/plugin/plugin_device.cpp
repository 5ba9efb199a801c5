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

constexpr int kClosingZeros = 5;
/// How long closing waits for a call to return.
constexpr std::chrono::seconds kPluginTimeout{2};

/// \throws DeviceError if no plug-in is named, or loading its library crashes
const std::filesystem::path& check_loadable(const std::filesystem::path& library) {
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
    const plugin::Library library(check_loadable(settings.plugin.library));
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
  (void)check_loadable(settings.plugin.library);
  return std::make_unique<PluginDevice>(settings.plugin);
}

}  // namespace

/// The library, the device, and the loop of its thread.
struct PluginDevice::Runtime {
  Runtime(const PluginSettings& settings, PluginOptions options)
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
    for (int i = 0; i < kClosingZeros; ++i) (void)device.force({});
    (void)device.enable(false);
    pace->end();
  }

  void tick() noexcept {
    if (link.fault() == DeviceFault::none) update_sample();
    const bool is_ready = readiness.load(std::memory_order_relaxed) == DeviceReadiness::ready;
    const std::optional<Vec3> force_n = is_ready ? link.live_force(pace->now()) : std::nullopt;
    enable(force_n.has_value());
    report_fault(device.force(force_n.value_or(Vec3{})));
  }

  void update_sample() noexcept {
    const plugin::Reading reading = device.sample();
    report_fault(reading.plugin_fault);
    if (reading.plugin_fault != plugin::PluginFault::none) return;
    readiness.store(reading.readiness, std::memory_order_release);
    if (reading.is_new) link.publish(reading.sample);
  }

  void enable(bool on) noexcept {
    if (on == is_enabled) return;
    is_enabled = on;
    report_fault(device.enable(on));
  }

  void report_fault(plugin::PluginFault fault) noexcept {
    if (fault == plugin::PluginFault::none) return;
    auto expected = plugin::PluginFault::none;
    plugin_fault.compare_exchange_strong(expected, fault, std::memory_order_acq_rel);
    link.fail(plugin::fault_of(fault));
  }

  plugin::Library library;
  plugin::OpenDevice device;
  DeviceInfo info;
  std::unique_ptr<LinkPace> pace;
  SchedulingRequest scheduling;
  LinkPace::Time period;
  DeviceLink link;
  bool is_enabled = false;  ///< used only by the device's thread
  std::atomic<DeviceReadiness> readiness{DeviceReadiness::needs_calibration};
  std::atomic<plugin::PluginFault> plugin_fault{plugin::PluginFault::none};
  std::atomic<bool> closing{false};
};

PluginDevice::PluginDevice(const PluginSettings& settings, PluginOptions options)
    : runtime_(std::make_shared<Runtime>(settings, std::move(options))) {
  std::packaged_task<void()> thread_work([runtime = runtime_] { runtime->run(); });
  thread_end_ = thread_work.get_future();
  thread_ = std::thread(std::move(thread_work));
}

PluginDevice::~PluginDevice() {
  runtime_->link.halt();
  runtime_->closing.store(true, std::memory_order_release);
  runtime_->pace->end();
  if (thread_end_.wait_for(kPluginTimeout) == std::future_status::ready) {
    thread_.join();
  } else {
    thread_.detach();  // a call hangs; its thread closes the device if it ever returns
  }
}

DeviceInfo PluginDevice::info() const {
  return runtime_->info;
}

DeviceLink& PluginDevice::link() const noexcept {
  return runtime_->link;
}

DeviceLink::Time PluginDevice::link_time() const noexcept {
  return runtime_->pace->now();
}

DeviceReadiness PluginDevice::readiness() const noexcept {
  return runtime_->readiness.load(std::memory_order_acquire);
}

plugin::PluginFault PluginDevice::plugin_fault() const noexcept {
  return runtime_->plugin_fault.load(std::memory_order_acquire);
}

DeviceDriver plugin_driver() {
  return {.name = "plugin",
          .what = "a lab's own driver, a shared library with touchtrial_device.h's interface",
          .list = list_plugins,
          .open = open_plugin,
          .workspace_is_known = false};
}

}  // namespace touchtrial::device
