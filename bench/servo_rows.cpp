// The servo's computations in a tick: a model's force, the kinematics of a Falcon, and the complete
// tick.
#include "app/commands/test_texture.hpp"
#include "bench/inputs.hpp"
#include "bench/rows.hpp"
#include "core/random.hpp"
#include "device/drivers/falcon/falcon_kinematics.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_clock.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"
#include "protocols/session/exploration.hpp"
#include "record/trace.hpp"
#include "tests/device/drivers/falcon/emulator/falcon_legs.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

namespace touchtrial::bench {
namespace {

/// The number of positions in one run, spaced as for a hand that moves at 100 mm/s.
constexpr int kPositions = 10'000;
constexpr double kStep_mm = 0.1;

/// \return positions on a square plane, 1 mm deep
std::vector<Vec3> stroke_path(double side_mm) {
  RandomStream random(1, "benchmark stroke");
  std::vector<Vec3> positions_mm;
  double heading = 0.0;
  Vec3 position_mm = {side_mm / 2, side_mm / 2, -1.0};
  for (int i = 0; i < kPositions; ++i) {
    heading += 0.2 * random.normal();
    position_mm.x = std::abs(position_mm.x + kStep_mm * std::cos(heading));
    position_mm.y = std::abs(position_mm.y + kStep_mm * std::sin(heading));
    positions_mm.push_back(
        {std::fmod(position_mm.x, side_mm), std::fmod(position_mm.y, side_mm), position_mm.z});
  }
  return positions_mm;
}

engine::RenderingOptions options_of(engine::ModelKind model) {
  engine::RenderingOptions options;
  options.model = model;
  return options;
}

struct ModelStroke {
  explicit ModelStroke(engine::ModelKind kind)
      : options(options_of(kind)),
        field(engine::make_texture_field(
            engine::extract_texture<double>(timed_image(kDefaultSize_px), {}).texture, options)),
        model(field.view(), options,
              engine::choose_gains(std::array{field.view()}, options).per_field[0]) {}

  void run() {
    for (const Vec3& position_mm : positions_mm)
      sum_n = sum_n + model.force_n(position_mm, {}, bristle);
  }

  engine::RenderingOptions options;
  engine::TextureField field;
  engine::RenderingModel model;
  engine::Bristle bristle;
  std::vector<Vec3> positions_mm = stroke_path(kDefaultSize_px * options.pitch_mm);
  Vec3 sum_n;  ///< prevents the compiler from removing evaluations
};

Row force_row(engine::ModelKind kind, const std::string& name) {
  Row row{.title = "force evaluation, " + name,
          .ours = timed(
              "touchtrial", [=] { return std::make_unique<ModelStroke>(kind); },
              [](const std::unique_ptr<ModelStroke>& stroke) { stroke->run(); }),
          .goal = {"us", 0.03}};
  row.ours.operations = kPositions;
  return row;
}

/// \return angles of a Falcon whose hand turns back 30 mm from the centre
std::vector<device::falcon::PerLeg> falcon_stroke_angles() {
  RandomStream random(1, "benchmark falcon");
  std::vector<device::falcon::PerLeg> readings;
  Vec3 position_mm;
  Vec3 heading = {1.0, 0.0, 0.0};
  for (int i = 0; i < kPositions; ++i) {
    heading = heading + 0.2 * Vec3{random.normal(), random.normal(), random.normal()};
    if (norm(position_mm) > 30.0) heading = -1.0 * position_mm;
    heading = (1.0 / norm(heading)) * heading;
    position_mm = position_mm + kStep_mm * heading;
    readings.push_back(
        device::falcon::reference_theta1(device::falcon::to_native_m(position_mm)).value());
  }
  return readings;
}

struct FalconStroke {
  std::vector<device::falcon::PerLeg> readings = falcon_stroke_angles();
  double sum_nm = 0.0;  ///< prevents the compiler from removing poses
};

Row falcon_row() {
  Row row{.title = "Falcon, angles to pose to torques",
          .ours = timed(
              "touchtrial", [] { return FalconStroke{}; },
              [](FalconStroke& stroke) {
                for (const device::falcon::PerLeg& reading : stroke.readings) {
                  const auto pose = device::falcon::forward_kinematics(reading);
                  stroke.sum_nm +=
                      device::falcon::torques_nm(pose.jacobian, {0.3, -0.2, 0.6}).value()[0];
                }
              })};
  row.ours.operations = kPositions;
  return row;
}

/// A stylus on a prescribed path: it descends from 2 mm above a plane to 1 mm depth and strokes at
/// up to 90 mm/s, in a closed figure of 10 s.
class ScriptedStylus final : public device::HapticDevice {
 public:
  explicit ScriptedStylus(double side_mm) {
    constexpr double kTau = 2.0 * std::numbers::pi;
    const Vec2 turns_per_s = {0.3, 0.2};
    const double reach_mm = 0.4 * side_mm;
    for (int i = 0; i < kPositions; ++i) {
      const Vec2 turn = 1e-3 * i * kTau * turns_per_s;
      const Vec2 speed_mm_s = reach_mm * kTau * turns_per_s;
      device::DeviceSample sample;
      sample.position_mm = {side_mm / 2 + reach_mm * std::sin(turn.x),
                            side_mm / 2 + reach_mm * std::sin(turn.y), 0.0};
      sample.velocity_mm_s = {speed_mm_s.x * std::cos(turn.x), speed_mm_s.y * std::cos(turn.y),
                              0.0};
      samples_.push_back(sample);
    }
  }

  [[nodiscard]] device::DeviceInfo info() const override {
    return {"scripted stylus", "", 3.3, true};
  }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    sample = samples_[ticks_ % samples_.size()];
    sample.position_mm.z = std::max(-1.0, 2.0 - 0.02 * static_cast<double>(ticks_));
    sample.sequence = ++ticks_;
    return device::DeviceStatus::ok;
  }
  [[nodiscard]] device::DeviceStatus write(Vec3) noexcept override {
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}

 private:
  std::vector<device::DeviceSample> samples_;
  std::uint64_t ticks_ = 0;
};

/// A real-time clock that never waits for a tick, and measures the time from tick to tick.
class ServiceClock final : public device::ServoClock {
 public:
  explicit ServiceClock(device::DurationHistogram& service) noexcept : service_(service) {}

  [[nodiscard]] Time now() noexcept override { return device::monotonic_now(); }
  void wait_until(Time) noexcept override {
    const Time end = device::monotonic_now();
    if (start_) service_.add(end - *start_);
    start_ = end;
  }

 private:
  device::DurationHistogram& service_;
  std::optional<Time> start_;
};

/// Reads samples from a ring and encodes them as a session does, until `is_ending` is set.
void encode_traces(device::SampleRing& ring, const std::atomic<bool>& is_ending) {
  constexpr std::size_t kTraceSamples = 60'000;
  std::vector<device::ServoSample> batch(1024);
  record::Trace trace;
  while (!is_ending) {
    const std::size_t count = ring.pop(batch);
    for (std::size_t i = 0; i < count; ++i) {
      trace.samples.push_back({batch[i].position_mm, batch[i].force_n});
    }
    if (trace.samples.size() >= kTraceSamples) {
      static_cast<void>(record::encode_trace(trace));
      trace.samples.clear();
    }
    if (count == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// \return the 99.9th percentile of the duration of a tick, with all hooks of a session and while its
///   trace is written. Ticks without waits outrun any writer, so the servo runs in bursts that fill
///   half the ring.
double tick_us() {
  constexpr std::size_t kRingSamples = 65'536;
  constexpr int kBursts = 60;
  const app::TestTexture texture(kDefaultSize_px);
  const engine::RenderingModel model = texture.texture();
  session::ModelForce force(model);
  ScriptedStylus stylus(texture.plane().width_mm());
  device::SampleRing ring(kRingSamples);
  device::RingSink sink(ring);
  std::atomic<bool> is_ending{false};
  std::thread writer([&] { encode_traces(ring, is_ending); });
  device::ServoControl control;
  device::LatestValue<device::ServoState> state;
  std::atomic<std::int64_t> heartbeat{0};
  device::FlightRecorder recorder(5.0, device::kServoRateHz);
  device::DurationHistogram service;
  for (int burst = 0; burst < kBursts; ++burst) {
    ServiceClock clock(service);
    static_cast<void>(device::run_servo(stylus, force, sink,
                                        {.limit_ticks = kRingSamples / 2, .fade_ticks = 0}, clock,
                                        {&control, &state, &heartbeat, &recorder}));
    while (ring.size() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  is_ending = true;
  writer.join();
  return service.percentile_us(0.999);
}

}  // namespace

Rows servo_rows() {
  return {force_row(engine::ModelKind::paper, "paper"),
          force_row(engine::ModelKind::surface, "surface"),
          falcon_row(),
          {.title = "work of a servo tick while its trace is written, 99.9 %",
           .ours = counted("touchtrial", tick_us),
           .goal = {"count", 2},
           .count_unit = "us"}};
}

}  // namespace touchtrial::bench
