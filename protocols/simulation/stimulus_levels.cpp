#include "protocols/simulation/stimulus_levels.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "device/drivers/registry.hpp"
#include "engine/perception/texture_sense.hpp"
#include "engine/perception/threshold_weights.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/felt_floor.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::simulation {
namespace {

/// Explorations of each plane, each as long as an interval of the default detection study.
constexpr std::size_t kExplorations = 8;
/// Explorations of the blank plane. If it can be felt, its variance between strokes determines the
/// threshold.
constexpr std::size_t kBlankExplorations = 64;
constexpr double kIntervalS = 2.5;
/// Maximum distance from the pack's gain at which an estimate is refined.
constexpr double kMaxRefinedDb = 40.0;

using Powers = std::array<double, engine::kSenseBins + 1>;
using BandPowers = std::array<double, kLevelBands.size()>;
constexpr std::size_t kCurves = engine::kThresholdCurves.size();

class NoSamples final : public device::SampleSink {
 public:
  void record(const device::ServoSample&) noexcept override {}
};

/// Senses one exploration by each threshold curve.
class CurveSenses final : public device::TipSense {
 public:
  explicit CurveSenses(const PlaneGeometry& plane) {
    for (std::size_t curve = 0; curve < kCurves; ++curve) {
      senses_[curve] = engine::TextureSense({.curve = engine::kThresholdCurves[curve]});
      senses_[curve].reset(plane);
    }
  }
  void feel(const Vec3& position_mm, const Vec3& force_n,
            const Vec3& acceleration_m_s2) noexcept override {
    for (engine::TextureSense& sense : senses_) sense.feel(position_mm, force_n, acceleration_m_s2);
  }
  [[nodiscard]] const engine::TextureSense& sense(std::size_t curve) const {
    return senses_[curve];
  }

 private:
  std::array<engine::TextureSense, kCurves> senses_;
};

/// Features by exploration.
using ExplorationFeatures = std::vector<engine::FeltFeatures>;

/// Features by curve and exploration.
struct PlaneFeatures {
  std::array<ExplorationFeatures, kCurves> features{};
  Powers powers{};  ///< mean over explorations
};

using Hands = std::vector<device::SimulatedHand>;

/// Explores a plane with several hands.
/// \param hands  before their first tick, one for each exploration
PlaneFeatures feel_plane(const engine::RenderingModel& model, const PlaneGeometry& plane,
                         const device::ServoOptions& servo,
                         std::span<const device::SimulatedHand> hands) {
  PlaneFeatures felt;
  for (device::SimulatedHand hand : hands) {
    CurveSenses senses(plane);
    hand.set_sense(senses);
    session::ModelForce force(model);
    NoSamples sink;
    static_cast<void>(device::run_servo_in_virtual_time(hand, force, sink, servo));
    for (std::size_t curve = 0; curve < kCurves; ++curve) {
      felt.features[curve].push_back(senses.sense(curve).features());
    }
    const Powers powers = senses.sense(0).mean_powers();
    for (std::size_t k = 0; k < powers.size(); ++k)
      felt.powers[k] += powers[k] / static_cast<double>(hands.size());
  }
  return felt;
}

const std::vector<double>& weights_of(engine::ThresholdCurve curve) {
  return engine::threshold_weights(curve, engine::kSenseWindow, device::kServoRateHz);
}

BandPowers band_powers(const Powers& powers, engine::ThresholdCurve curve) {
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
  return 10.0 * std::log10(std::max(power, std::pow(10.0, kNoLevelDb / 10.0)));
}

/// The median person of a subject model, who distinguishes a texture from the blank plane. The
/// weight of a feature is its change by the texture at full gain. Intervals differ by the person's
/// noise and by the path of the stroke.
class Detector {
 public:
  Detector(const SubjectModel& subject, const ExplorationFeatures& blank,
           const ExplorationFeatures& texture)
      : noise_{subject.feature_noise, subject.common_noise},
        floor_(floor_of(noise_, 0.0)),
        blank_(powers_of(blank)) {
    set_texture(0.0, texture);
    for (std::size_t i = 0; i < kExplorations; ++i) {
      const engine::FeltFeatures higher = perceived(i, 1.0);
      const engine::FeltFeatures lower = perceived(i, 0.0);
      for (std::size_t k = 0; k < weights_.size(); ++k) {
        weights_[k] += (higher[k] - lower[k]) / kExplorations;
      }
    }
    const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    const double squares =
        std::inner_product(weights_.begin(), weights_.end(), weights_.begin(), 0.0);
    deviation_ = std::sqrt(noise_.independent * noise_.independent * squares +
                           noise_.common * noise_.common * sum * sum + variance_of_blank());
  }

  /// Sets the features at one gain, from which the features at other gains are extrapolated.
  void set_texture(double gain_db, const ExplorationFeatures& felt) {
    texture_ = powers_of(felt);
    for (std::size_t i = 0; i < kExplorations; ++i) {
      for (std::size_t k = 0; k < texture_[i].size(); ++k) {
        texture_[i][k] = (texture_[i][k] - blank_[i][k]) / power_of(gain_db);
      }
    }
  }
  /// \return the gain at which the texture is distinguished from the blank plane, dB; empty if
  ///   there is none
  [[nodiscard]] std::optional<double> threshold_db() const {
    double below_db = kMinGainDb;
    double above_db = kMaxGainDb;
    if (!detects(above_db)) return std::nullopt;
    while (above_db - below_db > kStepDb) {
      const double middle_db = 0.5 * (below_db + above_db);
      (detects(middle_db) ? above_db : below_db) = middle_db;
    }
    return above_db;
  }

 private:
  static constexpr double kMinGainDb = -60.0;
  static constexpr double kMaxGainDb = 60.0;
  static constexpr double kStepDb = 1e-3;

  static double power_of(double gain_db) { return std::pow(10.0, gain_db / 10.0); }
  static ExplorationFeatures powers_of(ExplorationFeatures explored) {
    for (engine::FeltFeatures& features : explored) {
      for (double& feature : features) feature = std::exp(2.0 * feature);
    }
    return explored;
  }
  /// \param power  of the gain
  [[nodiscard]] engine::FeltFeatures perceived(std::size_t exploration, double power) const {
    engine::FeltFeatures felt = blank_[exploration];
    for (std::size_t k = 0; k < felt.size(); ++k) {
      const double sum = felt[k] + (power > 0.0 ? power * texture_[exploration][k] : 0.0);
      felt[k] = 0.5 * std::log(floor_.share * std::max(0.0, sum) + floor_.floor);
    }
    return felt;
  }
  [[nodiscard]] double strength(std::size_t exploration, double power) const {
    const engine::FeltFeatures felt = perceived(exploration, power);
    return std::inner_product(weights_.begin(), weights_.end(), felt.begin(), 0.0);
  }
  [[nodiscard]] double variance_of_blank() const {
    std::vector<double> strengths;
    for (std::size_t i = 0; i < blank_.size(); ++i) strengths.push_back(strength(i, 0.0));
    const auto count = static_cast<double>(strengths.size());
    const double mean = std::accumulate(strengths.begin(), strengths.end(), 0.0) / count;
    double squares = 0.0;
    for (const double value : strengths) squares += (value - mean) * (value - mean);
    return squares / (count - 1.0);
  }
  [[nodiscard]] bool detects(double gain_db) const {
    double difference = 0.0;
    for (std::size_t i = 0; i < kExplorations; ++i) {
      difference += (strength(i, power_of(gain_db)) - strength(i, 0.0)) / kExplorations;
    }
    return deviation_ > 0.0 && difference >= kThresholdDPrime * deviation_;
  }

  engine::FeltNoise noise_;
  FeltFloor floor_;
  ExplorationFeatures blank_;    // powers
  ExplorationFeatures texture_;  // powers that the texture at full gain adds to the blank plane's
  engine::FeltFeatures weights_{};
  double deviation_ = 0.0;  // standard deviation of the weighted sum between intervals
};

StimulusLevel level_of(const std::string& device, engine::ThresholdCurve curve,
                       const PlaneFeatures& felt, const PlaneFeatures* blank) {
  StimulusLevel level{.device = device, .curve = curve};
  const BandPowers bands = band_powers(felt.powers, curve);
  const BandPowers blank_bands =
      blank != nullptr ? band_powers(blank->powers, curve) : BandPowers{};
  for (std::size_t band = 0; band < bands.size(); ++band) {
    level.bands_db[band] = decibels(bands[band] / std::max(1.0, blank_bands[band]));
  }
  level.db = decibels(std::accumulate(bands.begin(), bands.end(), 0.0));
  return level;
}

}  // namespace

device::DeviceModel device_of(const study::Study& study) {
  const bool is_file =
      study.device.find('/') != std::string::npos || study.device.ends_with(".json");
  try {
    return device::model_of_device(is_file ? (study.folder / study.device).string() : study.device);
  } catch (const Error& error) {
    throw StudyError(one_line(study.source + ": /rendering/device: " + error.what()));
  }
}

std::vector<device::DeviceModel> level_devices(const study::Study& study) {
  if (study.device.empty()) return device::shipped_device_models();
  return {device_of(study)};
}

FieldLevels levels_of_fields(std::span<const engine::FieldWithGains> fields,
                             const study::Study& study,
                             const std::vector<device::DeviceModel>& devices, int jobs,
                             std::uint64_t seed) {
  PlaneGeometry plane = fields.front().field.geometry;
  for (const engine::FieldWithGains& field : fields) {
    plane.height_px = std::min(plane.height_px, field.field.geometry.height_px);
    plane.width_px = std::min(plane.width_px, field.field.geometry.width_px);
  }
  const device::ServoOptions servo = session::trial_servo_options(study, device::kServoRateHz, {});
  SubjectModel subject = default_subject();
  subject.sense = engine::ThresholdCurve::israr_2006;  // any curve: accelerations are then felt
  subject.explore_s = kIntervalS + device::SimulatedHand::kPushBuildUpS;
  // For each device, one hand per exploration, with the same paths for every plane. The weights of
  // the curves, which are computed once per process, are computed in parallel.
  std::vector<Hands> hands(devices.size());
  in_parallel(jobs, kCurves + devices.size(), [&](std::size_t i) {
    if (i < kCurves) {
      static_cast<void>(weights_of(engine::kThresholdCurves[i]));
      return;
    }
    SubjectModel on_device = subject;
    on_device.device = devices[i - kCurves];
    for (std::size_t path = 0; path < kBlankExplorations; ++path) {
      RandomStream random(seed, "levels: path", path);
      hands[i - kCurves].push_back(make_exploring_hand(on_device, plane, random));
      hands[i - kCurves].back().precompute();
    }
  });
  const auto feel_on = [&](std::size_t device, std::size_t field, double factor,
                           std::size_t explorations) {
    const engine::FieldWithGains& stroked_field = fields[field];
    const engine::Gains gains =
        engine::scaled_db(stroked_field.gains, study.trials.centre_gain_db());
    return feel_plane({stroked_field.field, study.rendering, engine::scaled(gains, factor)}, plane,
                      servo, std::span(hands[device]).first(explorations));
  };
  std::vector<PlaneFeatures> blanks(devices.size());
  in_parallel(jobs, devices.size(),
              [&](std::size_t d) { blanks[d] = feel_on(d, 0, 0.0, kBlankExplorations); });
  std::vector<PlaneLevels> levels(devices.size() * fields.size());
  in_parallel(jobs, levels.size(), [&](std::size_t i) {
    const std::size_t d = i / fields.size();
    const auto feel_at = [&](double gain_db) {
      return feel_on(d, i % fields.size(), std::pow(10.0, gain_db / 20.0), kExplorations);
    };
    const PlaneFeatures full = feel_at(0.0);
    for (std::size_t curve = 0; curve < kCurves; ++curve) {
      StimulusLevel level =
          level_of(devices[d].name, engine::kThresholdCurves[curve], full, &blanks[d]);
      Detector detector(subject, blanks[d].features[curve], full.features[curve]);
      std::optional<double> threshold_db = detector.threshold_db();
      if (threshold_db && std::abs(*threshold_db) < kMaxRefinedDb) {
        // A hand with friction and mass is not linear, so the estimate is refined near the
        // threshold.
        detector.set_texture(*threshold_db, feel_at(*threshold_db).features[curve]);
        threshold_db = detector.threshold_db();
      }
      level.db = threshold_db ? -*threshold_db : kNoLevelDb;
      levels[i].push_back(std::move(level));
    }
  });
  FieldLevels result;
  result.levels.resize(fields.size());
  for (std::size_t d = 0; d < devices.size(); ++d) {
    for (const engine::ThresholdCurve curve : engine::kThresholdCurves) {
      result.blank.push_back(level_of(devices[d].name, curve, blanks[d], nullptr));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      std::ranges::move(levels[d * fields.size() + i], std::back_inserter(result.levels[i]));
    }
  }
  return result;
}

StimulusLevels levels_of(const study::StudyCodes& key, const session::StimulusSource& source,
                         const std::vector<device::DeviceModel>& devices, int jobs,
                         std::uint64_t seed) {
  StimulusLevels result;
  std::vector<engine::FieldWithGains> fields;
  const LabelledFields labelled_fields(key, source);
  for (const LabelledField& labelled : labelled_fields.all()) {
    result.stimuli.push_back(labelled.stimulus);
    fields.push_back(source.field(key.code_of(labelled.stimulus)));
  }
  FieldLevels field_levels = levels_of_fields(fields, key.study, devices, jobs, seed);
  result.levels = std::move(field_levels.levels);
  result.blank = std::move(field_levels.blank);
  return result;
}

std::string name_of_stimulus(const study::Study& study, const study::StimulusIndex& index) {
  const study::StudyClass& study_class = study.classes[index.class_index];
  std::string name = study_class.label;
  if (study_class.images.size() > 1) name += fmt::format(" {}", index.exemplar + 1);
  if (study.presented_methods() > 1) name += ", " + study.methods[index.method].label;
  return name;
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
