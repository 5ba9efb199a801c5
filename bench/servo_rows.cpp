// The servo's computations in a tick: a model's force, the kinematics of a Falcon, and the whole
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

/// The number of places in one run, spaced as for a hand that moves at 100 mm/s.
constexpr int kPlaces = 10'000;
constexpr double kStep_mm = 0.1;

/// Places on a square plane, 1 mm deep.
std::vector<Vec3> stroke(double side_mm) {
  RandomStream random(1, "benchmark stroke");
  std::vector<Vec3> places_mm;
  double heading = 0.0;
  Vec3 place = {side_mm / 2, side_mm / 2, -1.0};
  for (int i = 0; i < kPlaces; ++i) {
    heading += 0.2 * random.normal();
    place.x = std::abs(place.x + kStep_mm * std::cos(heading));
    place.y = std::abs(place.y + kStep_mm * std::sin(heading));
    places_mm.push_back({std::fmod(place.x, side_mm), std::fmod(place.y, side_mm), place.z});
  }
  return places_mm;
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
              engine::choose_gains(std::array{field.view()}, options).of_field[0]) {}

  void run() {
    for (const Vec3& place_mm : places_mm) sum_n = sum_n + model.force_n(place_mm, {}, touch);
  }

  engine::RenderingOptions options;
  engine::TextureField field;
  engine::RenderingModel model;
  engine::Bristle touch;
  std::vector<Vec3> places_mm = stroke(kDefaultSize_px * options.pitch_mm);
  Vec3 sum_n;  ///< keeps the compiler from removing evaluations
};

Row force_row(engine::ModelKind kind, const std::string& name) {
  Row row{.what = "force evaluation, " + name,
          .ours = timed(
              "touchtrial", [=] { return std::make_unique<ModelStroke>(kind); },
              [](const std::unique_ptr<ModelStroke>& stroke) { stroke->run(); }),
          .goal = {"us", 0.03}};
  row.ours.operations = kPlaces;
  return row;
}

/// Angles of a Falcon whose hand turns back 30 mm from the middle.
std::vector<device::falcon::PerLeg> readings_of_a_stroke() {
  RandomStream random(1, "benchmark falcon");
  std::vector<device::falcon::PerLeg> readings;
  Vec3 place_mm;
  Vec3 heading = {1.0, 0.0, 0.0};
  for (int i = 0; i < kPlaces; ++i) {
    heading = heading + 0.2 * Vec3{random.normal(), random.normal(), random.normal()};
    if (norm(place_mm) > 30.0) heading = -1.0 * place_mm;
    heading = (1.0 / norm(heading)) * heading;
    place_mm = place_mm + kStep_mm * heading;
    readings.push_back(
        device::falcon::reference_theta1(device::falcon::to_native_m(place_mm)).value());
  }
  return readings;
}

struct FalconStroke {
  std::vector<device::falcon::PerLeg> readings = readings_of_a_stroke();
  double sum_nm = 0.0;  ///< keeps the compiler from removing poses
};

Row falcon_row() {
  Row row{.what = "Falcon, angles to pose to torques",
          .ours = timed(
              "touchtrial", [] { return FalconStroke{}; },
              [](FalconStroke& stroke) {
                for (const device::falcon::PerLeg& reading : stroke.readings) {
                  const auto pose = device::falcon::forward_kinematics(reading);
                  stroke.sum_nm +=
                      device::falcon::torques_nm(pose.jacobian, {0.3, -0.2, 0.6}).value()[0];
                }
              })};
  row.ours.operations = kPlaces;
  return row;
}

/// A stylus on a prescribed path: it comes down from 2 mm and strokes a plane 1 mm deep at up to 90
/// mm/s, in a closed figure of 10 s.
class LedStylus final : public device::HapticDevice {
 public:
  explicit LedStylus(double side_mm) {
    constexpr double kTau = 2.0 * std::numbers::pi;
    const Vec2 turns_per_s = {0.3, 0.2};
    const double reach_mm = 0.4 * side_mm;
    for (int i = 0; i < kPlaces; ++i) {
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

  [[nodiscard]] device::DeviceInfo info() const override { return {"led stylus", "", 3.3, true}; }
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

/// A real-time clock that never waits for a tick, and measures the time between two.
class ServiceClock final : public device::ServoClock {
 public:
  explicit ServiceClock(device::DurationHistogram& service) noexcept : service_(service) {}

  [[nodiscard]] Time now() noexcept override { return device::monotonic_now(); }
  void wait_until(Time) noexcept override {
    const Time end = device::monotonic_now();
    if (begin_) service_.add(end - *begin_);
    begin_ = end;
  }

 private:
  device::DurationHistogram& service_;
  std::optional<Time> begin_;
};

/// Reads samples from a ring and encodes them as a session does, until `ending` is set.
void encode_traces(device::SampleRing& ring, const std::atomic<bool>& ending) {
  constexpr std::size_t kSamplesOfTrace = 60'000;
  std::vector<device::ServoSample> batch(1024);
  record::Trace trace;
  while (!ending) {
    const std::size_t got = ring.pop(batch);
    for (std::size_t i = 0; i < got; ++i) {
      trace.samples.push_back({batch[i].position_mm, batch[i].force_n});
    }
    if (trace.samples.size() >= kSamplesOfTrace) {
      static_cast<void>(record::encode_trace(trace));
      trace.samples.clear();
    }
    if (got == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// The 99.9th percentile of the time of one tick, with all hooks of a session and its trace written
/// meanwhile. Ticks that do not wait outrun any writer, so the servo runs in bursts that fill half
/// the ring.
double tick_us() {
  constexpr std::size_t kRingSamples = 65'536;
  constexpr int kBursts = 60;
  const app::TestTexture texture(kDefaultSize_px);
  const engine::RenderingModel model = texture.texture();
  session::ModelForce force(model);
  LedStylus stylus(texture.plane().width_mm());
  device::SampleRing ring(kRingSamples);
  device::RingSink sink(ring);
  std::atomic<bool> ending{false};
  std::thread writer([&] { encode_traces(ring, ending); });
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
    while (ring.waiting() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ending = true;
  writer.join();
  return service.percentile_us(0.999);
}

}  // namespace

Rows servo_rows() {
  return {force_row(engine::ModelKind::paper, "paper"),
          force_row(engine::ModelKind::surface, "surface"),
          falcon_row(),
          {.what = "work of a servo tick while its trace is written, 99.9 %",
           .ours = counted("touchtrial", tick_us),
           .goal = {"count", 2},
           .count_unit = "us"}};
}

}  // namespace touchtrial::bench
