// What an acceptance finds on device models with planted parameters, and what it refuses.
#include "device/acceptance/acceptance.hpp"

#include "core/files.hpp"
#include "device/acceptance/rehearsal.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using namespace device;

const std::vector<std::string> kEmulated = {"falcon", "touch", "omega_3", "inverse3"};

Certificate rehearsed(const DeviceModel& model, const AcceptanceOptions& options = {}) {
  return device::rehearse_acceptance(model, options).certificate;
}

const AxisResult& axis_of(const Certificate& certificate, DeviceAxis axis) {
  const auto found = std::ranges::find(certificate.axes, axis, &AxisResult::axis);
  REQUIRE(found != certificate.axes.end());
  return *found;
}

/// Whether the stated interval holds the planted value, and is no wider than this.
void check_found(const std::optional<Measured>& found, double planted, double widest) {
  REQUIRE(found);
  CAPTURE(found->value, found->error, planted);
  CHECK(std::abs(found->value - planted) <= found->error);
  CHECK(found->error <= widest);
}

/// Whether one of the lines names `places` (support/names.hpp).
bool has_line(const std::vector<std::string>& lines, const std::string& places) {
  return std::ranges::any_of(lines, [&](const std::string& line) { return names(line, places); });
}

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

double& component(Vec3& v, DeviceAxis axis) {
  if (axis == DeviceAxis::x) return v.x;
  return axis == DeviceAxis::y ? v.y : v.z;
}

/// A rehearsal that keeps the greatest forces, by the run's name.
class WatchedRehearsal final : public AcceptanceBench {
 public:
  explicit WatchedRehearsal(const DeviceModel& model) : rehearsal_(model) {}
  [[nodiscard]] DeviceInfo info() const override { return rehearsal_.info(); }
  [[nodiscard]] SafetyLimits limits() const override { return rehearsal_.limits(); }
  void limit_force(double max_n) override { rehearsal_.limit_force(max_n); }
  [[nodiscard]] ServoReport run(const std::string& name, Measurement& measurement) override {
    ServoReport report = rehearsal_.run(name, measurement);
    double max_n = 0.0;
    for (const ServoSample& sample : measurement.samples()) {
      max_n = std::max(max_n, norm(sample.force_n));
    }
    greatest_n_.emplace_back(name, max_n);
    return report;
  }
  [[nodiscard]] Rehearsal& person() { return rehearsal_; }
  [[nodiscard]] const auto& greatest_n() const { return greatest_n_; }

 private:
  Rehearsal rehearsal_;
  std::vector<std::pair<std::string, double>> greatest_n_;
};

}  // namespace

TEST_CASE("an acceptance passes each emulated device and finds the parameters of its model") {
  for (const std::string& name : kEmulated) {
    CAPTURE(name);
    const DeviceModel model = device_model(name);
    const Certificate certificate = rehearsed(model);
    INFO(joined_lines(certificate.failures()));
    CHECK(certificate.passed());
    CHECK(certificate.emulated == name);
    check_found(certificate.step_mm, model.position_step_mm, 0.1 * model.position_step_mm);
    for (const DeviceAxis axis : kDeviceAxes) {
      CAPTURE(name_of(axis));
      const AxisResult& result = axis_of(certificate, axis);
      check_found(result.scale(), 1.0, 0.08);
      check_found(result.friction_n, model.coulomb_n, 0.10);
      check_found(result.mass_kg, model.mass_kg, 0.3 * model.mass_kg + 0.01);
      check_found(result.delay_ms, model.delay_ticks, 1.5);
    }
  }
}

TEST_CASE("an acceptance finds a wrong sign on any axis, refuses it, and pulls at nothing more") {
  for (const std::string& name : kEmulated) {
    for (const DeviceAxis axis : kDeviceAxes) {
      CAPTURE(name, name_of(axis));
      DeviceModel model = device_model(name);
      component(model.planted_faults.force_sign_scale, axis) = -1.0;
      WatchedRehearsal bench(model);
      const Certificate certificate = accept_device(bench, bench.person(), {}).certificate;
      CHECK_FALSE(certificate.passed());
      CHECK(has_line(certificate.failures(), "axis " + std::string(name_of(axis))));
      REQUIRE(!bench.greatest_n().empty());
      CHECK(bench.greatest_n().back().first == "push " + std::string(name_of(axis)));
      // Friction alone holds the handle: a push ends within 0.2 N beyond it, and the hand's own
      // spring of 0.05 N/mm over 2 mm.
      CHECK(bench.greatest_n().back().second <= model.coulomb_n + 0.1 + 0.2 + 1e-9);
      CHECK_FALSE(certificate.not_measured.empty());
    }
  }
}

TEST_CASE("an acceptance finds a force that is 20 percent off on one axis, and refuses it") {
  for (const std::string& name : kEmulated) {
    for (const double scale : {0.8, 1.2}) {
      for (const DeviceAxis axis : kDeviceAxes) {
        CAPTURE(name, scale, name_of(axis));
        DeviceModel model = device_model(name);
        component(model.planted_faults.force_sign_scale, axis) = scale;
        const Certificate certificate = rehearsed(model);
        check_found(axis_of(certificate, axis).scale(), scale, 0.09);
        CHECK_FALSE(certificate.passed());
        CHECK(certificate.failures().size() == 1);
        CHECK(has_line(certificate.failures(), "axis " + std::string(name_of(axis))));
        // Friction and mass are in newtons at the handle, whatever the scale.
        check_found(axis_of(certificate, axis).friction_n, model.coulomb_n, 0.15);
      }
    }
  }
}

TEST_CASE("an acceptance finds 3 ms of delay, 0.3 N of friction and steps of 0.06 mm") {
  for (const std::string& name : kEmulated) {
    CAPTURE(name);
    DeviceModel model = device_model(name);
    model.delay_ticks = 3;
    model.coulomb_n = 0.3;
    model.position_step_mm = 0.06;
    const Certificate certificate = rehearsed(model);
    INFO(joined_lines(certificate.failures()));
    CHECK(certificate.passed());
    check_found(certificate.step_mm, 0.06, 0.006);
    for (const DeviceAxis axis : kDeviceAxes) {
      CAPTURE(name_of(axis));
      check_found(axis_of(certificate, axis).delay_ms, 3.0, 1.5);
      check_found(axis_of(certificate, axis).friction_n, 0.3, 0.10);
    }
  }
}

TEST_CASE("an acceptance finds planted parameters through noise, whatever its seed") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    DeviceModel model = device_model("falcon");
    model.delay_ticks = 3;
    model.planted_faults.position_noise_mm = 0.02;
    model.planted_faults.gravity_n = 0.6;
    model.planted_faults.seed = seed;
    const Certificate certificate = rehearsed(model);
    INFO(joined_lines(certificate.failures()));
    CHECK(certificate.passed());
    REQUIRE(axis_of(certificate, DeviceAxis::y).load_n);
    CHECK(*axis_of(certificate, DeviceAxis::y).load_n == Approx(0.6).margin(0.05));
    for (const DeviceAxis axis : kDeviceAxes) {
      CAPTURE(name_of(axis));
      check_found(axis_of(certificate, axis).scale(), 1.0, 0.08);
      check_found(axis_of(certificate, axis).friction_n, 0.3, 0.10);
      check_found(axis_of(certificate, axis).delay_ms, 3.0, 1.5);
      check_found(axis_of(certificate, axis).mass_kg, model.mass_kg, 0.06);
    }
  }
}

TEST_CASE("an acceptance records what it could not measure, and why") {
  DeviceModel model = device_model("falcon");
  model.position_step_mm = 0.0;
  const Certificate certificate = rehearsed(model, {.skip = {"wall", "shake"}});
  CHECK(certificate.passed());
  const auto why = [&](const std::string& what) {
    const auto found = std::ranges::find(certificate.not_measured, what, &NotMeasured::measurement);
    return found == certificate.not_measured.end() ? std::string() : found->reason;
  };
  CHECK_FALSE(certificate.step_mm);
  CHECK_FALSE(why("encoder step").empty());
  CHECK_FALSE(why("stiffest wall").empty());
  CHECK(why("mass and delay on axis x") == why("stiffest wall"));
  CHECK_THAT(why("force after twenty minutes"), holds_text("--thermal"));
  CHECK_FALSE(axis_of(certificate, DeviceAxis::x).mass_kg);
}

TEST_CASE(
    "an acceptance without signs, rest or weights does not pass, and nothing pulls unsigned") {
  const DeviceModel model = device_model("falcon");
  const Certificate unsigned_one = rehearsed(model, {.skip = {"push"}});
  CHECK_FALSE(unsigned_one.passed());
  CHECK(unsigned_one.axes.empty());
  CHECK_FALSE(rehearsed(model, {.skip = {"rest"}}).passed());
  CHECK_FALSE(rehearsed(model, {.skip = {"weights"}}).passed());
}

TEST_CASE("an acceptance refuses devices that fall silent, are lost, tremble, stick or lag") {
  const auto refused = [](const char* places, const auto& plant) {
    DeviceModel model = device_model("omega_3");
    plant(model);
    const Certificate certificate = rehearsed(model);
    CAPTURE(places, joined_lines(certificate.failures()));
    CHECK_FALSE(certificate.passed());
    CHECK(has_line(certificate.failures(), places));
  };
  refused("stale_sample", [](DeviceModel& m) { m.planted_faults.silent_after_s = 60.0; });
  refused("link_lost", [](DeviceModel& m) { m.planted_faults.lost_after_s = 30.0; });
  refused("mm", [](DeviceModel& m) { m.planted_faults.position_noise_mm = 0.15; });
  refused("axis", [](DeviceModel& m) { m.coulomb_n = 2.0; });
  refused("5 ms", [](DeviceModel& m) { m.delay_ticks = 8; });
  refused("0.1 mm", [](DeviceModel& m) { m.position_step_mm = 0.2; });
}

TEST_CASE("no emulated device with more delay than the limit passes, by ticks or by slow motors") {
  for (const DeviceModel& shipped : shipped_device_models()) {
    if (shipped.mass_kg == 0.0) continue;  // ideal
    for (const int ticks : {6, 10, 12, 15, 20, 30}) {
      DeviceModel model = shipped;
      model.delay_ticks = ticks;
      const Certificate certificate = rehearsed(model);
      CAPTURE(shipped.name, ticks, joined_lines(certificate.failures()));
      CHECK_FALSE(certificate.passed());
    }
    for (const double hz : {4.0, 10.0, 20.0, 30.0}) {  // 5 to 40 ms beside the delay
      DeviceModel model = shipped;
      model.lowpass_hz = hz;
      const Certificate certificate = rehearsed(model);
      CAPTURE(shipped.name, hz, joined_lines(certificate.failures()));
      CHECK_FALSE(certificate.passed());
    }
  }
}

TEST_CASE("a shake that gave no delay fails a device with its reason, unless it was left out") {
  DeviceModel model = device_model("omega_3");
  model.delay_ticks = 12;
  model.velocity_readings = 20;  // so slow that the hold itself swings
  const Certificate failed = rehearsed(model);
  CHECK_FALSE(failed.passed());
  CHECK_FALSE(axis_of(failed, DeviceAxis::x).delay_left_out);
  const Certificate left_out = rehearsed(device_model("omega_3"), {.skip = {"shake"}});
  CHECK(left_out.passed());
  CHECK(axis_of(left_out, DeviceAxis::x).delay_left_out);
}

TEST_CASE("a wall that throws the handle up slowly, again and again, is no stable wall") {
  // Two to four swings in a second, 12 mm and more from peak to peak at 5 N/mm.
  const std::vector<std::pair<std::string, int>> slow = {
      {"omega_3", 12}, {"omega_3", 15}, {"omega_3", 20}, {"inverse3", 20}, {"falcon", 25}};
  for (const auto& [name, ticks] : slow) {
    CAPTURE(name, ticks);
    DeviceModel model = device_model(name);
    model.delay_ticks = ticks;
    model.max_stiffness_n_per_mm = 5.0;
    const Certificate certificate = rehearsed(model);
    REQUIRE(certificate.wall);
    CHECK(certificate.wall->ended == "oscillation");
    CHECK(certificate.wall->stable_n_per_mm < 2.0);
  }
}

TEST_CASE("friction up to the limit is measured beside a weight") {
  for (const std::string name : {"falcon", "omega_3", "inverse3"}) {
    for (const double friction_n : {0.65, 0.7}) {
      CAPTURE(name, friction_n);
      DeviceModel model = device_model(name);
      model.coulomb_n = friction_n;
      const Certificate certificate = rehearsed(model);
      for (const DeviceAxis axis : kDeviceAxes) {
        check_found(axis_of(certificate, axis).scale(), 1.0, 0.09);
        check_found(axis_of(certificate, axis).friction_n, friction_n, 0.15);
      }
    }
  }
}

TEST_CASE("an acceptance pushes with at most 1.5 N and the continuous force, then 60 % of peak") {
  for (const std::string& name : kEmulated) {
    CAPTURE(name);
    const DeviceModel model = device_model(name);
    WatchedRehearsal bench(model);
    static_cast<void>(accept_device(bench, bench.person(), {}));
    const double peak_n = std::min(model.max_force_n, SafetyLimits{}.max_force_n);
    const double continuous_n = model.continuous_force_n > 0.0 ? model.continuous_force_n : peak_n;
    for (const auto& [run, greatest_n] : bench.greatest_n()) {
      CAPTURE(run);
      CHECK(greatest_n <= 0.6 * peak_n + 1e-9);
      if (run.starts_with("push")) {
        CHECK(greatest_n <= std::min(1.5, continuous_n) + 1e-9);
      }
      if (run == "rest" || run == "steps") CHECK(greatest_n == 0.0);
    }
  }
}

TEST_CASE(
    "walls become stiffer until one swings, near the stiffness that damping and delay allow") {
  // A hand of 8 N s/m alone damps the handle, so K (T/2 + delay) = 8 N s/m at the edge.
  DeviceModel model = device_model("ideal");
  model.mass_kg = 0.1;
  model.max_force_n = 8.0;
  model.zero_order_hold = true;
  model.delay_ticks = 10;
  const Certificate certificate = rehearsed(model);
  REQUIRE(certificate.wall);
  CHECK(certificate.wall->ended == "oscillation");
  CHECK(certificate.wall->oscillates_n_per_mm > certificate.wall->stable_n_per_mm);
  const double edge_n_per_mm = 8.0 / (0.5 + 10.0);
  CHECK(certificate.wall->stable_n_per_mm < 1.3 * edge_n_per_mm);
  CHECK(certificate.wall->oscillates_n_per_mm > edge_n_per_mm / 1.7);
  // Without the delay the same hand is stable to the maker's limit, and beyond it nothing is tried.
  model.delay_ticks = 0;
  model.max_stiffness_n_per_mm = 0.4;
  const Certificate stable = rehearsed(model);
  REQUIRE(stable.wall);
  CHECK(stable.wall->ended == "the maker's limit");
  CHECK(stable.wall->stable_n_per_mm == 0.4);
  CHECK(stable.wall->oscillates_n_per_mm == 0.0);
}

TEST_CASE("an acceptance repeats itself exactly, and its model rehearses as the device did") {
  const DeviceModel model = device_model("falcon");
  const Certificate first = rehearsed(model);
  CHECK(certificate_json(first) == certificate_json(rehearsed(model)));
  device::Certificate named = first;
  named.driver = "falcon";
  CHECK(device::model_of(named, {}).provenance.at("mass_kg").confidence == Confidence::derived);
  named.emulated.clear();
  const DeviceModel measured = device::model_of(named, ModelledDevice(model).info());
  CHECK(measured.mass_kg == Approx(model.mass_kg).epsilon(0.15));
  CHECK(measured.coulomb_n == Approx(model.coulomb_n).margin(0.05));
  CHECK(measured.delay_ticks == model.delay_ticks);
  CHECK(measured.zero_order_hold);
  CHECK(measured.provenance.at("zero_order_hold").confidence == Confidence::guess);
  CHECK(measured.provenance.at("mass_kg").confidence == Confidence::measured);
  const DeviceModel read = parse_device_model(device::device_model_json(measured), "model");
  CHECK(read.mass_kg == measured.mass_kg);
}

TEST_CASE("after twenty minutes under a load an acceptance compares the forces that it took") {
  AcceptanceOptions options{.thermal = true};
  const Certificate certificate = rehearsed(device_model("omega_3"), options);
  REQUIRE(certificate.warm);
  CHECK(certificate.warm->after_n == Approx(certificate.warm->before_n).epsilon(0.02));
  CHECK_FALSE(certificate.warm->before_c);
  CHECK(certificate.passed());
}

}  // namespace touchtrial
