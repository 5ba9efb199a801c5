#include "protocols/simulation/threshold_tracks.hpp"

#include "core/random.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/servo/servo.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_exploration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

namespace touchtrial {
namespace {

constexpr PlaneGeometry kPlane{0.4, 500, 500};
constexpr double kIntervalS = 2.5;
constexpr int kIntervals = 3;

/// The wall of the default studies, and a vibration in time.
class VibratingWall final : public device::ForceSource {
 public:
  explicit VibratingWall(const Vibration& vibration) : vibration_(vibration) {}
  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    const double turns = vibration_.frequency_hz * static_cast<double>(tick_++) * 1e-3;
    const double wave_n = vibration_.force_n * std::sin(2.0 * std::numbers::pi * turns);
    constexpr double kStiffnessNPerMm = 0.4;
    return {wave_n, 0.0, std::max(0.0, -kStiffnessNPerMm * sample.position_mm.z)};
  }

 private:
  Vibration vibration_;
  std::int64_t tick_ = 0;
};

class NoSink final : public device::SampleSink {
 public:
  void record(const device::ServoSample&) noexcept override {}
};

/// A hand that strokes so fast that the vibration's wavelength is one that is felt.
simulation::SubjectModel stroking(simulation::SubjectModel subject, double frequency_hz) {
  constexpr double kWavelengthMm = 2.0;
  subject.slowest_mm_s = subject.fastest_mm_s =
      std::clamp(kWavelengthMm * frequency_hz, 60.0, 300.0);
  subject.explore_s = kIntervalS;
  return subject;
}

/// Strokes the vibrating wall.
void explore(const simulation::SubjectModel& subject, const Vibration& vibration,
             RandomStream random, simulation::HandSense& sense) {
  device::SimulatedHand hand = simulation::make_exploring_hand(subject, kPlane, random);
  sense.begin(hand, kPlane);
  VibratingWall wall(vibration);
  NoSink sink;
  static_cast<void>(device::run_servo_in_virtual_time(hand, wall, sink, {}));
}

engine::FeltFeatures felt(const simulation::SubjectModel& subject, const Vibration& vibration,
                          RandomStream random) {
  simulation::HandSense sense(subject);
  explore(subject, vibration, random, sense);
  return sense.features();
}

/// What one person notices of a stronger vibration: the features, each by how much it should
/// change.
class StrengthObserver {
 public:
  StrengthObserver(const simulation::SubjectModel& subject, double frequency_hz, std::uint64_t seed,
                   int number)
      : subject_(stroking(subject, frequency_hz)),
        frequency_hz_(frequency_hz),
        person_(subject_, seed, number),
        random_(seed, "tracks: answers", static_cast<std::uint64_t>(number)),
        paths_(seed, "tracks: paths", static_cast<std::uint64_t>(number)) {}

  /// \return whether the person finds the stronger one among three intervals
  [[nodiscard]] bool finds(double weaker_n, double stronger_n) {
    // What the person expects: the same exploration with each.
    const RandomStream way(paths_.below(1U << 30U), "tracks: expected", 0);
    const engine::FeltFeatures low = perceived(felt(subject_, {frequency_hz_, weaker_n}, way));
    const engine::FeltFeatures high = perceived(felt(subject_, {frequency_hz_, stronger_n}, way));
    const auto target = static_cast<int>(random_.below(kIntervals));
    int found = 0;
    double most = 0.0;
    for (int interval = 0; interval < kIntervals; ++interval) {
      const double force_n = interval == target ? stronger_n : weaker_n;
      engine::FeltFeatures now =
          perceived(felt(subject_, {frequency_hz_, force_n},
                         RandomStream(paths_.below(1U << 30U), "tracks: interval", 0)));
      const double shared = person_.noise().common * random_.normal();
      double strength = 0.0;
      for (int i = 0; i < engine::kFeltFeatures; ++i) {
        const double feature = now[i] + shared + person_.noise().independent * random_.normal();
        strength += (high[i] - low[i]) * feature;
      }
      if (interval == 0 || strength > most) {
        most = strength;
        found = interval;
      }
    }
    return found == target;
  }

 private:
  [[nodiscard]] engine::FeltFeatures perceived(engine::FeltFeatures features) const {
    if (person_.floor()) person_.floor()->apply_to(features);
    return features;
  }

  simulation::SubjectModel subject_;
  double frequency_hz_;
  simulation::Individual person_;
  RandomStream random_;
  RandomStream paths_;
};

/// A one-up three-down track on a level in dB.
/// \param right  whether the answer at a level is right
/// \return the mean level of the last reversals
double settled_db(double start_db, const std::function<bool(double)>& right) {
  constexpr int kFirst = 2;
  constexpr int kCounted = 8;
  double level_db = start_db;
  std::vector<double> reversals_db;
  int in_a_row = 0;
  int direction = 0;
  while (reversals_db.size() < kFirst + kCounted) {
    const double step_db = reversals_db.size() < kFirst ? 4.0 : 1.0;
    int next = 0;
    if (!right(level_db)) {
      next = 1;
    } else if (++in_a_row == 3) {
      next = -1;
    }
    if (next == 0) continue;
    in_a_row = 0;
    if (direction != 0 && next != direction) reversals_db.push_back(level_db);
    direction = next;
    level_db += next * step_db;
  }
  double sum_db = 0.0;
  for (int i = 0; i < kCounted; ++i) sum_db += reversals_db[kFirst + i];
  return sum_db / kCounted;
}

TrackResult mean_of_tracks(int tracks, const std::function<double(int)>& level_db_of_track) {
  std::vector<double> levels_db;
  double mean_db = 0.0;
  for (int track = 1; track <= tracks; ++track) {
    levels_db.push_back(level_db_of_track(track));
    mean_db += levels_db.back() / tracks;
  }
  double squares = 0.0;
  for (const double level_db : levels_db) squares += (level_db - mean_db) * (level_db - mean_db);
  return {std::pow(10.0, mean_db / 20.0), std::sqrt(squares / (tracks - 1.0) / tracks)};
}

}  // namespace

TrackResult detected(const simulation::SubjectModel& subject, double frequency_hz, int tracks,
                     std::uint64_t seed) {
  constexpr double kStartDb = -20.0;  // re 1 N
  return mean_of_tracks(tracks, [&](int track) {
    StrengthObserver observer(subject, frequency_hz, seed, track);
    return settled_db(kStartDb, [&](double level_db) {
      return observer.finds(0.0, std::pow(10.0, level_db / 20.0));
    });
  });
}

TrackResult told_apart(const simulation::SubjectModel& subject, double frequency_hz,
                       double standard_n, int tracks, std::uint64_t seed) {
  // The track is on the logarithm of the difference: its level cannot fall below none.
  constexpr double kStartDb = 0.0;
  const TrackResult difference = mean_of_tracks(tracks, [&](int track) {
    StrengthObserver observer(subject, frequency_hz, seed, track);
    return settled_db(kStartDb, [&](double level_db) {
      return observer.finds(standard_n, standard_n * (1.0 + std::pow(10.0, level_db / 20.0)));
    });
  });
  return {standard_n * (1.0 + difference.force_n), difference.error_db};
}

double displacement_m_per_n(const simulation::SubjectModel& subject, double frequency_hz,
                            double force_n) {
  class Tip final : public device::TipSense {
   public:
    void feel(const Vec3& position_mm, const Vec3& /*force_n*/,
              const Vec3& /*acceleration_m_s2*/) noexcept override {
      x_mm.push_back(position_mm.x);
    }
    std::vector<double> x_mm;
  };
  constexpr int kSettling = 1000;
  constexpr int kMeasured = 1000;
  std::array<Tip, 2> tips;
  for (const bool vibrates : {false, true}) {
    RandomStream random(1, "tracks: displacement");
    device::SimulatedHand hand =
        simulation::make_exploring_hand(stroking(subject, frequency_hz), kPlane, random);
    hand.set_sense(tips[vibrates ? 1 : 0]);
    VibratingWall wall({frequency_hz, vibrates ? force_n : 0.0});
    NoSink sink;
    static_cast<void>(device::run_servo_in_virtual_time(hand, wall, sink, {}));
  }
  std::complex<double> sum_mm;
  for (int i = kSettling; i < kSettling + kMeasured; ++i) {
    const double turns = frequency_hz * i * 1e-3;
    sum_mm += (tips[1].x_mm.at(i) - tips[0].x_mm.at(i)) *
              std::polar(1.0, -2.0 * std::numbers::pi * turns);
  }
  return 2.0 * std::abs(sum_mm) / kMeasured * 1e-3 / force_n;
}

double vibration_power(double frequency_hz, double force_n) {
  simulation::SubjectModel subject{.sense = engine::ThresholdCurve::israr_2006};
  simulation::HandSense sense(subject);
  explore(stroking(subject, frequency_hz), {frequency_hz, force_n},
          RandomStream(1, "tracks: power"), sense);
  double sum = 0.0;
  for (const double power : sense.mean_powers()) sum += power;
  return sum;
}

}  // namespace touchtrial
