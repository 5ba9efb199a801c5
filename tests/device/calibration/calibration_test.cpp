#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/calibration/certificate.hpp"
#include "protocols/design/refusal.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <functional>

namespace touchtrial {
namespace {

/// A handle of 150 g that hangs in the air, with a weight on a string, and motors that give
/// `force_constant` times the commanded force.
class Scale final : public device::HapticDevice {
 public:
  Scale(double force_constant, device::CalibrationAxis axis, double mass_g)
      : force_constant_(force_constant),
        mass_kg_(0.15 + 0.001 * mass_g),
        pull_n_{0.0, -0.15 * device::kStandardGravityMS2, 0.0} {
    const double weight_n = 0.001 * mass_g * device::kStandardGravityMS2;
    if (axis == device::CalibrationAxis::x) pull_n_.x += weight_n;
    if (axis == device::CalibrationAxis::y) pull_n_.y -= weight_n;
    if (axis == device::CalibrationAxis::z) pull_n_.z += weight_n;
  }

  [[nodiscard]] device::DeviceInfo info() const override { return {"scale", "S1", 8.0}; }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    ++state_.sequence;
    sample = state_;
    return device::DeviceStatus::ok;
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    constexpr double kFrictionNSPerMm = 0.0005;
    const Vec3 total_n =
        force_constant_ * force_n + pull_n_ - kFrictionNSPerMm * state_.velocity_mm_s;
    state_.velocity_mm_s =
        state_.velocity_mm_s + (device::kServoTickS * 1000.0 / mass_kg_) * total_n;
    if (!is_let_go_) state_.velocity_mm_s = {};
    state_.position_mm = state_.position_mm + device::kServoTickS * state_.velocity_mm_s;
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}
  /// A hand holds the handle, and nothing moves.
  void hold_by_hand() { is_let_go_ = false; }

 private:
  double force_constant_;
  double mass_kg_;
  Vec3 pull_n_;
  bool is_let_go_ = true;
  device::DeviceSample state_;
};

device::HoldFigures held(Scale& scale,
                         device::HoldMeasurement::Mode mode = device::HoldMeasurement::Mode::hold,
                         double seconds = device::HoldMeasurement::kRunS) {
  device::HoldMeasurement hold(mode);
  device::ServoOptions options;
  options.limit_ticks = std::llround(seconds * device::kServoRateHz);
  CHECK(device::run_servo_in_virtual_time(scale, hold, hold, options).end ==
        device::ServoEnd::time_limit);
  return hold.figures();
}

device::AxisResult measured(double force_constant, device::CalibrationAxis axis, double mass_g) {
  Scale empty(force_constant, axis, 0.0);
  Scale loaded(force_constant, axis, mass_g);
  return device::judge_axis(axis, mass_g, held(empty), held(loaded));
}

device::Certificate passed_certificate() {
  device::Certificate certificate{"falcon", "Novint Falcon", "F1", "", "0.1.0", {}, {}, {}};
  certificate.made = std::chrono::sys_days(std::chrono::year(2026) / 2 / 28) +
                     std::chrono::hours(9) + std::chrono::seconds(5);
  for (const device::CalibrationAxis axis : device::kCalibrationAxes) {
    certificate.axes.push_back({axis, 100.0, 0.980665, 1.01, 0.02, true});
  }
  certificate.free_air = {0.01, 0.02, 1.5, true};
  return certificate;
}

}  // namespace

TEST_CASE("a hold commands the weight that hangs on the handle") {
  Scale scale(1.0, device::CalibrationAxis::y, 100.0);
  const device::HoldFigures figures = held(scale);
  REQUIRE(figures.measured);
  CHECK(figures.force_n.y == Approx(0.25 * device::kStandardGravityMS2).epsilon(0.002));
  CHECK(figures.force_n.x == Approx(0.0).margin(1e-9));
  CHECK(figures.noise_mm < 0.02);
}

TEST_CASE(
    "a force constant that is 5 percent off passes on every axis, and its error is reported") {
  for (const device::CalibrationAxis axis : device::kCalibrationAxes) {
    const device::AxisResult result = measured(0.95, axis, 100.0);
    CHECK(result.passed);
    CHECK(result.expected_n == Approx(0.980665));
    CHECK(result.measured_n == Approx(0.980665 / 0.95).epsilon(0.003));
    CHECK(result.cross_n < 0.01);
  }
}

TEST_CASE("a force constant that is 15 percent off fails on every axis, in either direction") {
  for (const device::CalibrationAxis axis : device::kCalibrationAxes) {
    CHECK_FALSE(measured(0.85, axis, 100.0).passed);
    CHECK_FALSE(measured(1.15, axis, 100.0).passed);
    CHECK(measured(1.05, axis, 100.0).passed);
  }
}

TEST_CASE("a run that ended early measured nothing and passes nothing") {
  Scale scale(1.0, device::CalibrationAxis::y, 0.0);
  const device::HoldFigures figures = held(scale, device::HoldMeasurement::Mode::hold, 6.5);
  CHECK_FALSE(figures.measured);
  Scale whole(1.0, device::CalibrationAxis::y, 100.0);
  CHECK_FALSE(device::judge_axis(device::CalibrationAxis::y, 100.0, figures, held(whole)).passed);
}

TEST_CASE("a falling handle is not at rest, and one that lies still is") {
  Scale falling(1.0, device::CalibrationAxis::y, 0.0);
  Scale empty(1.0, device::CalibrationAxis::y, 0.0);
  const device::HoldFigures hold = held(empty);
  device::ServoOptions slow_enough;
  device::HoldMeasurement rest(device::HoldMeasurement::Mode::rest);
  slow_enough.limits.max_speed_mm_s = 1e9;
  slow_enough.limit_ticks = 8000;
  (void)device::run_servo_in_virtual_time(falling, rest, rest, slow_enough);
  CHECK_FALSE(device::judge_free_air(rest.figures(), hold).passed);
  Scale still(1.0, device::CalibrationAxis::y, 0.0);
  still.hold_by_hand();
  const device::FreeAirResult result =
      device::judge_free_air(held(still, device::HoldMeasurement::Mode::rest), hold);
  CHECK(result.passed);
  CHECK(result.noise_mm == 0.0);
  CHECK(result.residual_n == Approx(0.15 * device::kStandardGravityMS2).epsilon(0.003));
}

TEST_CASE("a certificate is read as it was written, with its hash") {
  const TempFolder folder;
  const auto path = folder.path() / "certificate.json";
  const std::string text = device::certificate_json(passed_certificate());
  replace_file(path, text);
  const device::ReadCertificate read = device::read_certificate(path);
  CHECK(device::certificate_json(read.certificate) == text);
  CHECK(read.certificate.made == passed_certificate().made);
  CHECK(read.hash == sha256_of_file(path));
  CHECK(text.find("2026-02-28T09:00:05Z") != std::string::npos);
}

TEST_CASE("a certificate that was changed by hand is refused with the place") {
  const TempFolder folder;
  const auto path = folder.path() / "certificate.json";
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = device::certificate_json(passed_certificate());
    text.replace(text.find(from), from.size(), to);
    replace_file(path, text);
    return message_of<StudyError>([&] { return device::read_certificate(path); });
  };
  CHECK_THAT(changed("\"passed\": true", "\"passed\": false"), holds_text("/passed"));
  CHECK_THAT(changed("2026-02-28", "2026-02-30"), holds_text("/made"));
  CHECK_THAT(changed("calibration 1", "calibration 9"), holds_text("/kind"));
  CHECK_THAT(changed("\"serial\"", "\"cereal\""), holds_text("/cereal"));
}

TEST_CASE(
    "a certificate whose results do not follow from its measurements is refused with the place") {
  const TempFolder folder;
  const auto path = folder.path() / "certificate.json";
  const auto refusal = [&](const std::function<void(device::Certificate&)>& change) {
    device::Certificate certificate = passed_certificate();
    change(certificate);
    replace_file(path, device::certificate_json(certificate));
    return message_of<StudyError>([&] { return device::read_certificate(path); });
  };
  CHECK_THAT(refusal([](device::Certificate& c) { c.axes[1].measured_n = 1.2; }),
             holds_text("/axes/1/passed"));
  CHECK_THAT(refusal([](device::Certificate& c) { c.axes[1].measured_n = 0.0; }),
             holds_text("/axes/1/passed"));
  CHECK_THAT(refusal([](device::Certificate& c) { c.axes[2].expected_n = c.axes[2].measured_n; }),
             holds_text("/axes/2/expected_n"));
  CHECK_THAT(refusal([](device::Certificate& c) { c.axes[2].axis = c.axes[0].axis; }),
             holds_text("/axes/2/axis"));
  CHECK_THAT(refusal([](device::Certificate& c) { c.axes[0].mass_g = c.axes[0].expected_n = 0.0; }),
             holds_text("/axes/0/passed"));
  CHECK_THAT(refusal([](device::Certificate& c) { c.free_air.drift_mm = 0.6; }),
             holds_text("/free_air/passed"));
  CHECK_THAT(refusal([](device::Certificate& c) { c.free_air.noise_mm = 0.2; }),
             holds_text("/free_air/passed"));
}

TEST_CASE("a certificate is valid for its own device only, and only if it passed") {
  const device::Certificate certificate = passed_certificate();
  const device::DeviceInfo device{"falcon", "F1", 8.0};
  const auto soon = certificate.made + std::chrono::days(30);
  CHECK(device::check_certificate(certificate, device, soon).empty());
  const device::DeviceInfo other{"falcon", "F2", 8.0};
  CHECK(refuses<DeviceError>([&] { return device::check_certificate(certificate, other, soon); },
                             "F2"));
  device::Certificate failed = certificate;
  failed.axes[1].passed = false;
  CHECK(refuses<DeviceError>([&] { return device::check_certificate(failed, device, soon); },
                             "failed"));
  failed = certificate;
  failed.axes.pop_back();
  CHECK_FALSE(failed.passed());
}

TEST_CASE("a certificate that is half a year old causes a warning") {
  const device::Certificate certificate = passed_certificate();
  const device::DeviceInfo device{"falcon", "F1", 8.0};
  CHECK(device::check_certificate(certificate, device, certificate.made + std::chrono::days(180))
            .empty());
  CHECK_THAT(
      device::check_certificate(certificate, device, certificate.made + std::chrono::days(200)),
      holds_text("200 days"));
}

}  // namespace touchtrial
