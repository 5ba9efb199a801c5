#include "device/servo/flight_recorder.hpp"

#include "device/servo/servo.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace touchtrial::device {
namespace {

constexpr double kMaxTicks = 1e7;

constexpr std::string_view kHeader =
    "tick,time_s,x_mm,y_mm,z_mm,vx_mm_s,vy_mm_s,vz_mm_s,requested_x_n,requested_y_n,requested_z_n,"
    "sent_x_n,sent_y_n,sent_z_n,verdict,fault,device_fault,lateness_us,sequence,buttons,ready,"
    "delivered_x_n,delivered_y_n,delivered_z_n\r\n";

std::size_t ring_size_for(double seconds, double rate_hz) {
  const double ticks = std::ceil(seconds * rate_hz);
  if (!(seconds > 0.0 && rate_hz > 0.0 && ticks <= kMaxTicks)) {
    throw std::invalid_argument("FlightRecorder: duration or rate is out of range");
  }
  return static_cast<std::size_t>(ticks);
}

/// Writes one row of values.
class Row {
 public:
  explicit Row(std::string& text) : text_(text) {}

  template <typename Number>
  void add(Number value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    add(std::string_view(digits.data(), end));
  }
  void add(std::string_view word) {
    if (!is_first_) text_ += ',';
    text_ += word;
    is_first_ = false;
  }
  void add(Vec3 v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(const std::optional<Vec3>& v) {
    if (v) return add(*v);
    for (int i = 0; i < 3; ++i) add(std::string_view());
  }
  void end() { text_ += "\r\n"; }

 private:
  std::string& text_;
  bool is_first_ = true;
};

void add_row(std::string& text, const FlightTick& tick) {
  Row row(text);
  row.add(tick.tick);
  row.add(std::chrono::duration<double>(tick.time).count());
  row.add(tick.sample.position_mm);
  row.add(tick.sample.velocity_mm_s);
  row.add(tick.requested_n);
  row.add(tick.sent_n);
  row.add(name_of(tick.verdict));
  row.add(name_of(tick.fault));
  row.add(name_of(tick.device_fault));
  row.add(tick.lateness_us);
  row.add(tick.sample.sequence);
  row.add(tick.sample.buttons);
  row.add(tick.sample.ready ? 1 : 0);
  row.add(tick.sample.delivered_n);
  row.end();
}

}  // namespace

FlightRecorder::FlightRecorder(double seconds, double rate_hz)
    : ring_(ring_size_for(seconds, rate_hz)) {}

void FlightRecorder::record(const FlightTick& tick) noexcept {
  ring_[recorded_ % ring_.size()] = tick;
  ++recorded_;
}

std::vector<FlightTick> FlightRecorder::ticks() const {
  const std::size_t recorded = std::min(recorded_, ring_.size());
  std::vector<FlightTick> ticks;
  ticks.reserve(recorded);
  for (std::size_t i = recorded_ - recorded; i < recorded_; ++i) {
    ticks.push_back(ring_[i % ring_.size()]);
  }
  return ticks;
}

std::string flight_csv(std::span<const FlightTick> ticks) {
  std::string text(kHeader);
  for (const FlightTick& tick : ticks) add_row(text, tick);
  return text;
}

}  // namespace touchtrial::device
