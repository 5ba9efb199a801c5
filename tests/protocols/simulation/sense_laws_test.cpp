// Laws of the sense by published thresholds: what the simulated participant detects and tells apart
// is what the curves and the noise say. That is self-consistency and no proof that people do.
#include "engine/perception/vibration_threshold.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_floor.hpp"
#include "protocols/simulation/threshold_tracks.hpp"
#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace touchtrial {
namespace {

using engine::ThresholdCurve;

simulation::SubjectModel by(ThresholdCurve curve) {
  return {.sense = curve, .feature_noise = 0.28, .common_noise = 0.14};
}

double detected_re_curve_db(const simulation::SubjectModel& subject, double frequency_hz,
                            const TrackResult& track) {
  const double moved_m = track.force_n * displacement_m_per_n(subject, frequency_hz, 0.05);
  return 20.0 *
         std::log10(moved_m / engine::threshold_displacement_m(*subject.sense, frequency_hz));
}

}  // namespace

TEST_CASE("law 7: a three-interval track on sines returns the published threshold") {
  const ThresholdCurve curve = GENERATE(ThresholdCurve::israr_2006, ThresholdCurve::tan_1994);
  const double frequency_hz = GENERATE(10.0, 40.0, 160.0, 320.0);
  const simulation::SubjectModel subject = by(curve);
  const TrackResult track = detected(subject, frequency_hz, 12, 1);
  const double level_db = detected_re_curve_db(subject, frequency_hz, track);
  INFO(engine::name_of(curve) << " at " << frequency_hz << " Hz: " << level_db << " +- "
                              << track.error_db << " dB re the curve");
  CHECK(std::abs(level_db) < 1.0 + 2.0 * track.error_db);
  CHECK(track.error_db < 0.7);
}

TEST_CASE("the smallest difference of amplitude is the published one with the default's noise") {
  // Israr and Tan 2006: 29 to 33 %, which is 2.2 to 2.5 dB.
  const TrackResult track = told_apart(by(ThresholdCurve::israr_2006), 80.0, 0.1, 12, 2);
  const double difference_db = 20.0 * std::log10(track.force_n / 0.1);
  INFO(difference_db << " dB");
  CHECK(difference_db > 1.7);
  CHECK(difference_db < 3.0);
}

TEST_CASE("law 9: twice the force is 6.02 dB more, and more mass is never more") {
  const ThresholdCurve curve = GENERATE(ThresholdCurve::israr_2006, ThresholdCurve::tan_1994);
  simulation::SubjectModel subject = by(curve);
  const double single = displacement_m_per_n(subject, 40.0, 0.05);
  CHECK(displacement_m_per_n(subject, 40.0, 0.1) == Approx(single).epsilon(1e-6));
  double last = single;
  for (const double mass_kg : {0.05, 0.1, 0.2, 0.4}) {
    subject.device.mass_kg = mass_kg;
    const double heavier = displacement_m_per_n(subject, 40.0, 0.05);
    CHECK(heavier < last);
    last = heavier;
  }
}

TEST_CASE("law 10: far above the threshold features are as without one, far below all are alike") {
  const simulation::FeltFloor floor = simulation::floor_of({0.28, 0.14}, 0.0);
  std::array above{std::log(10.0)};  // 20 dB
  floor.apply_to(above);
  CHECK(above[0] == Approx(std::log(10.0)).epsilon(0.004));
  std::array below{std::log(0.01), std::log(0.001)};
  floor.apply_to(below);
  CHECK(std::abs(below[0] - below[1]) < 1e-4);
  std::array at{0.0};
  std::array none{std::log(1e-9)};
  floor.apply_to(at);
  floor.apply_to(none);
  CHECK(at[0] - none[0] ==
        Approx(simulation::kThresholdDPrime * simulation::strength_noise({0.28, 0.14})));
  // A person who is 6.02 dB more sensitive feels half as much as well.
  const simulation::FeltFloor keen = simulation::floor_of({0.28, 0.14}, 20.0 * std::log10(2.0));
  std::array half{std::log(0.5)};
  keen.apply_to(half);
  CHECK(half[0] == Approx(at[0]));
}

TEST_CASE("table: what the simulated participant detects and tells apart", "[.table]") {
  for (const ThresholdCurve curve : engine::kThresholdCurves) {
    for (const char* held : {"ideal", "touch", "falcon"}) {
      simulation::SubjectModel subject = by(curve);
      subject.device = device::device_model(held);
      for (const double frequency_hz : {10.0, 20.0, 40.0, 80.0, 160.0, 320.0}) {
        const TrackResult track = detected(subject, frequency_hz, 24, 1);
        std::printf("| %s | %s | %.0f | %.1f | %.1f | %.1f +- %.1f |\n",
                    std::string(engine::name_of(curve)).c_str(), held, frequency_hz,
                    20.0 * std::log10(engine::threshold_displacement_m(curve, frequency_hz) / 1e-6),
                    1000.0 * track.force_n, detected_re_curve_db(subject, frequency_hz, track),
                    track.error_db);
      }
    }
    // 20 dB above the threshold.
    const double standard_n = 10.0 * detected(by(curve), 80.0, 24, 1).force_n;
    const TrackResult track = told_apart(by(curve), 80.0, standard_n, 24, 2);
    std::printf("difference of amplitude at 80 Hz, %s: %.2f dB\n",
                std::string(engine::name_of(curve)).c_str(),
                20.0 * std::log10(track.force_n / standard_n));
  }
}

}  // namespace touchtrial
