#include "device/instruments/lab_streaming.hpp"

#include "core/errors.hpp"
#include "device/platform/dynamic_library.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>

namespace touchtrial::device {
namespace {

constexpr const char* kRemedy =
    "install liblsl, name the library in the device settings at instruments.lsl.library, or remove "
    "instruments.lsl";

// Types and values of the library's C interface.
using StreamInfo = void*;
using Outlet = void*;
using StreamDescription = void*;
constexpr int kDouble64 = 2;
constexpr int kString = 3;
constexpr double kIrregularRate = 0.0;
constexpr std::int32_t kChunkAsPushed = 0;
constexpr std::int32_t kBufferedS = 360;
constexpr std::int32_t kChunkSize = 1;

struct LslApi {
  StreamInfo (*create_streaminfo)(const char*, const char*, std::int32_t, double, int, const char*);
  void (*destroy_streaminfo)(StreamInfo);
  StreamDescription (*get_desc)(StreamInfo);
  StreamDescription (*append_child)(StreamDescription, const char*);
  StreamDescription (*append_child_value)(StreamDescription, const char*, const char*);
  Outlet (*create_outlet)(StreamInfo, std::int32_t, std::int32_t);
  void (*destroy_outlet)(Outlet);
  std::int32_t (*push_doubles)(Outlet, const double*, double, std::int32_t);
  std::int32_t (*push_texts)(Outlet, const char**, double, std::int32_t);
  double (*local_clock)();
};

LslApi load_lsl(const DynamicLibrary& library) {
  LslApi api{};
  library.find("lsl_create_streaminfo", api.create_streaminfo);
  library.find("lsl_destroy_streaminfo", api.destroy_streaminfo);
  library.find("lsl_get_desc", api.get_desc);
  library.find("lsl_append_child", api.append_child);
  library.find("lsl_append_child_value", api.append_child_value);
  library.find("lsl_create_outlet", api.create_outlet);
  library.find("lsl_destroy_outlet", api.destroy_outlet);
  library.find("lsl_push_sample_dtp", api.push_doubles);
  library.find("lsl_push_sample_strtp", api.push_texts);
  library.find("lsl_local_clock", api.local_clock);
  return api;
}

/// A channel of the position and force stream.
struct Channel {
  const char* label;
  const char* unit;
  const char* type;
};
constexpr std::array<Channel, 6> kChannels = {{{"x", "millimeters", "Position"},
                                               {"y", "millimeters", "Position"},
                                               {"z", "millimeters", "Position"},
                                               {"fx", "newtons", "Force"},
                                               {"fy", "newtons", "Force"},
                                               {"fz", "newtons", "Force"}}};

double seconds_of(LabStreaming::TimePoint time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace

struct LabStreaming::Outlets {
  Outlets(const LabStreamingSettings& settings, double rate_hz)
      : library(settings.library, Unload::never, kRemedy), api(load_lsl(library)) {
    markers = make_outlet(settings.name + " markers", "Markers", 1, kIrregularRate, kString);
    try {
      hand = make_outlet(settings.name + " hand", "MoCap", static_cast<int>(kChannels.size()),
                         rate_hz, kDouble64);
    } catch (...) {
      api.destroy_outlet(markers);
      throw;
    }
  }
  ~Outlets() {
    api.destroy_outlet(hand);
    api.destroy_outlet(markers);
  }
  Outlets(const Outlets&) = delete;
  Outlets& operator=(const Outlets&) = delete;

  [[nodiscard]] Outlet make_outlet(const std::string& name, const char* type, int channels,
                                   double rate_hz, int format) const {
    // Without a source id, recorders do not resume the stream, which suits a new session.
    StreamInfo info = api.create_streaminfo(name.c_str(), type, channels, rate_hz, format, "");
    if (info == nullptr) {
      throw DeviceError(
          one_line("instruments.lsl: liblsl cannot create the stream '" + name + "'; " + kRemedy));
    }
    if (format == kDouble64) describe_channels(info);
    Outlet outlet = api.create_outlet(info, kChunkAsPushed, kBufferedS);
    api.destroy_streaminfo(info);
    if (outlet != nullptr) return outlet;
    throw DeviceError(one_line("instruments.lsl: liblsl cannot create the outlet '" + name +
                               "'; check that the network allows it, or remove instruments.lsl"));
  }

  void describe_channels(StreamInfo info) const {
    StreamDescription channels = api.append_child(api.get_desc(info), "channels");
    for (const auto& [label, unit, type] : kChannels) {
      StreamDescription channel = api.append_child(channels, "channel");
      static_cast<void>(api.append_child_value(channel, "label", label));
      static_cast<void>(api.append_child_value(channel, "unit", unit));
      static_cast<void>(api.append_child_value(channel, "type", type));
    }
  }

  [[nodiscard]] double stamp_of(TimePoint time) const noexcept {
    return seconds_of(time) + offset_s.load(std::memory_order_relaxed);
  }

  DynamicLibrary library;
  LslApi api;
  Outlet markers = nullptr;
  Outlet hand = nullptr;
  std::atomic<double> offset_s{0.0};
};

LabStreaming::LabStreaming(const LabStreamingSettings& settings, double rate_hz) {
  check_loads(settings.library, kRemedy);
  outlets_ = std::make_unique<Outlets>(settings, rate_hz);
  static_cast<void>(read_clock());
}

LabStreaming::~LabStreaming() = default;

void LabStreaming::mark(const std::string& text, TimePoint time) noexcept {
  const char* channel = text.c_str();
  static_cast<void>(
      outlets_->api.push_texts(outlets_->markers, &channel, outlets_->stamp_of(time), kChunkSize));
}

void LabStreaming::push(Vec3 position_mm, Vec3 force_n, TimePoint time) noexcept {
  const std::array<double, kChannels.size()> values = {position_mm.x, position_mm.y, position_mm.z,
                                                       force_n.x,     force_n.y,     force_n.z};
  static_cast<void>(outlets_->api.push_doubles(outlets_->hand, values.data(),
                                               outlets_->stamp_of(time), kChunkSize));
}

ClockOffset LabStreaming::read_clock() noexcept {
  constexpr int kReadings = 5;
  ClockOffset best{0.0, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < kReadings; ++i) {
    const double before_s = seconds_of(std::chrono::steady_clock::now());
    const double layer_s = outlets_->api.local_clock();
    const double after_s = seconds_of(std::chrono::steady_clock::now());
    const double half_s = 0.5 * (after_s - before_s);
    if (half_s < best.uncertainty_s) best = {layer_s - (before_s + half_s), half_s};
  }
  outlets_->offset_s.store(best.offset_s, std::memory_order_relaxed);
  return best;
}

}  // namespace touchtrial::device
