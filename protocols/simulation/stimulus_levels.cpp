#include "protocols/simulation/stimulus_levels.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "device/registry.hpp"
#include "engine/perception/threshold_weights.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace touchtrial::simulation {
namespace {

/// Explorations of each plane.
constexpr int kPasses = 2;

using Powers = std::array<double, engine::kSenseBins + 1>;
using BandPowers = std::array<double, kLevelBands.size()>;

class NoSamples final : public device::SampleSink {
 public:
  void record(const device::ServoSample&) noexcept override {}
};

/// Mean powers of the tip's acceleration in one exploration.
/// \param hand  before its first tick
Powers stroked(const engine::RenderingModel& model, const PlaneGeometry& plane,
               const SubjectModel& subject, const device::ServoOptions& servo,
               device::SimulatedHand hand) {
  HandSense sense(subject);
  sense.begin(hand, plane);
  session::ModelForce force(model);
  NoSamples sink;
  static_cast<void>(device::run_servo_in_virtual_time(hand, force, sink, servo));
  return sense.mean_powers();
}

const std::vector<double>& weights_of(engine::ThresholdCurve curve) {
  return engine::threshold_weights(curve, engine::kSenseWindow, device::kServoRateHz);
}

BandPowers in_bands(const Powers& powers, engine::ThresholdCurve curve) {
  const std::vector<double>& weights = weights_of(curve);
  BandPowers bands{};
  for (std::size_t k = 1; k < powers.size(); ++k) {
    const double frequency_hz =
        static_cast<double>(k) * device::kServoRateHz / engine::kSenseWindow;
    const auto band = std::ranges::find_if(
        kLevelBands, [&](const LevelBand& b) { return frequency_hz < b.to_hz; });
    const auto place =
        std::min<std::ptrdiff_t>(band - kLevelBands.begin(), std::ssize(kLevelBands) - 1);
    bands[static_cast<std::size_t>(place)] += weights[k] * powers[k];
  }
  return bands;
}

double decibels(double power) noexcept {
  constexpr double kNothing = 1e-10;  // -100 dB
  return 10.0 * std::log10(std::max(power, kNothing));
}

double sum_of(const BandPowers& bands) noexcept {
  double sum = 0.0;
  for (const double band : bands) sum += band;
  return sum;
}

/// The factor on the texture's part that makes the sum stand 10 dB above the blank or threshold.
double gain_for_10_db(double felt, double blank) noexcept {
  const double texture = felt - blank;
  if (!(texture > 0.0)) return 0.0;
  return std::sqrt((10.0 * std::max(1.0, blank) - blank) / texture);
}

/// \param blank  null for the blank plane itself
StimulusLevel level_of(const std::string& device, engine::ThresholdCurve curve,
                       const BandPowers& felt, const BandPowers* blank) {
  StimulusLevel level{.device = device, .curve = curve};
  const auto beside = [&](double power) { return std::max(1.0, power); };
  const double blank_sum = blank != nullptr ? sum_of(*blank) : 0.0;
  level.db = decibels(sum_of(felt) / beside(blank_sum));
  for (std::size_t band = 0; band < felt.size(); ++band) {
    level.bands_db[band] = decibels(felt[band] / beside(blank != nullptr ? (*blank)[band] : 0.0));
  }
  if (blank != nullptr) level.gain_for_10_db = gain_for_10_db(sum_of(felt), blank_sum);
  return level;
}

}  // namespace

device::DeviceModel device_of(const design::Study& study) {
  const bool is_file =
      study.device.find('/') != std::string::npos || study.device.ends_with(".json");
  try {
    return device::model_of_device(is_file ? (study.folder / study.device).string() : study.device);
  } catch (const Error& error) {
    throw StudyError(one_line(study.source + ": /rendering/device: " + error.what()));
  }
}

std::vector<device::DeviceModel> level_devices(const design::Study& study) {
  if (study.device.empty()) return device::shipped_device_models();
  return {device_of(study)};
}

StimulusLevels levels_of(const design::StudyCodes& key, const session::StimulusSource& source,
                         const std::vector<device::DeviceModel>& devices, int jobs,
                         std::uint64_t seed) {
  const LabelledFields fields(key, source);
  StimulusLevels result;
  std::vector<const engine::RenderingModel*> planes;
  for (const LabelledField& field : fields.all()) {
    result.stimuli.push_back(field.stimulus);
    planes.push_back(field.model);
  }
  planes.push_back(&source.flat());
  const device::ServoOptions servo =
      session::trial_servo_options(key.study, device::kServoRateHz, {});
  std::vector<SubjectModel> subjects(devices.size());
  for (std::size_t d = 0; d < devices.size(); ++d) {
    subjects[d].sense = engine::ThresholdCurve::israr_2006;  // so that accelerations are felt
    subjects[d].device = devices[d];
  }
  // By device and pass: the same path on every plane. Meanwhile the weights of each curve, which
  // are worked out once in a program's life, while whoever else asks for them waits.
  constexpr std::size_t kCurves = engine::kThresholdCurves.size();
  std::vector<std::optional<device::SimulatedHand>> hands(devices.size() * kPasses);
  in_parallel(jobs, kCurves + hands.size(), [&](std::size_t i) {
    if (i < kCurves) {
      static_cast<void>(weights_of(engine::kThresholdCurves[i]));
      return;
    }
    const std::size_t hand = i - kCurves;
    RandomStream random(seed, "levels: path", hand % kPasses);
    hands[hand].emplace(make_exploring_hand(subjects[hand / kPasses], fields.plane(), random));
    hands[hand]->foresee();
  });
  std::vector<Powers> powers(devices.size() * planes.size() * kPasses);
  in_parallel(jobs, powers.size(), [&](std::size_t i) {
    const std::size_t pass = i % kPasses;
    const std::size_t plane = i / kPasses % planes.size();
    const std::size_t device = i / kPasses / planes.size();
    powers[i] = stroked(*planes[plane], fields.plane(), subjects[device], servo,
                        *hands[device * kPasses + pass]);
  });
  const auto mean_of = [&](std::size_t device, std::size_t plane) {
    Powers mean{};
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
      const Powers& own = powers[(device * planes.size() + plane) * kPasses + pass];
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += own[k] / kPasses;
    }
    return mean;
  };
  result.levels.resize(result.stimuli.size());
  for (std::size_t d = 0; d < devices.size(); ++d) {
    const Powers none = mean_of(d, planes.size() - 1);
    for (const engine::ThresholdCurve curve : engine::kThresholdCurves) {
      const BandPowers blank = in_bands(none, curve);
      result.blank.push_back(level_of(devices[d].name, curve, blank, nullptr));
      for (std::size_t i = 0; i < result.stimuli.size(); ++i) {
        result.levels[i].push_back(
            level_of(devices[d].name, curve, in_bands(mean_of(d, i), curve), &blank));
      }
    }
  }
  return result;
}

LevelRange range_on(const PlaneLevels& levels, const std::string& device) {
  LevelRange range{1e9, -1e9};
  for (const StimulusLevel& level : levels) {
    if (level.device != device) continue;
    range.low_db = std::min(range.low_db, level.db);
    range.high_db = std::max(range.high_db, level.db);
  }
  return range;
}

}  // namespace touchtrial::simulation
