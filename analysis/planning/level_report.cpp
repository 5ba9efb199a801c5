#include "analysis/planning/level_report.hpp"

#include "analysis/report/methods.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "protocols/simulation/felt_floor.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

using Json = nlohmann::ordered_json;
using simulation::LevelBand;
using simulation::LevelRange;
using simulation::name_of_stimulus;
using simulation::PlaneLevels;
using simulation::StimulusLevel;
using simulation::StimulusLevels;

constexpr std::size_t kMaxComparedStimuli = 40;
constexpr const char* kBlank = "blank plane";

constexpr const char* kTitle = "Strength of the stimuli";
constexpr const char* kCurveNote =
    "Decibels by which a stimulus's gain lies above the one at which a simulated person "
    "distinguishes it from the blank plane with 79 % right in three intervals, from one published "
    "curve of thresholds to "
    "the other: the conservative one (tan_1994) and the sensitive one (israr_2006). The blank "
    "plane itself: power above the curve. Vibrations are those of the tip of a modelled device in "
    "a simulated hand.";
constexpr const char* kPilotNote =
    "Decibels by which a stimulus's gain lies above the one at which people of this laboratory, on "
    "its device, would distinguish it from the blank plane with 79 % right in three intervals: the "
    "thresholds of its detection study (/rendering/gains/curve), carried to these stimuli by a "
    "modelled device in a simulated hand. The blank plane itself: power above the curve.";
constexpr const char* kSimulatedPilotNote =
    "SIMULATED: decibels above the level that simulated pilots distinguish from the blank plane "
    "with 79 % right in three intervals; a rehearsal of the detection study with people.";
constexpr const char* kProvisionalNote =
    "Provisional, until a detection study with pilot participants replaces the curve "
    "(docs/perception.md). The curves were measured on other people with passive, steady "
    "vibrations; active movement raises thresholds. They are not validated until they predict "
    "human data to which they were not fitted.";

std::vector<std::string> devices_of(const StimulusLevels& levels) {
  std::vector<std::string> devices;
  for (const StimulusLevel& level : levels.blank) {
    if (std::ranges::find(devices, level.device) == devices.end()) devices.push_back(level.device);
  }
  return devices;
}

std::string range_cell(double low_db, double high_db) {
  constexpr double kNegligibleDb = -60.0;
  if (high_db < kNegligibleDb) return "none";
  const auto rounded = [](double db) {
    return db < kNegligibleDb ? "none" : fmt::format("{}", static_cast<int>(std::lround(db)));
  };
  const std::string low = rounded(low_db);
  const std::string high = rounded(high_db);
  return low == high ? low : low + " to " + high;
}

std::string range_cell(const PlaneLevels& levels, const std::string& device) {
  const LevelRange range = simulation::range_on(levels, device);
  return range_cell(range.low_db, range.high_db);
}

std::string band_cell(const PlaneLevels& levels, std::size_t band) {
  double low_db = 1e9;
  double high_db = -1e9;
  for (const StimulusLevel& level : levels) {
    low_db = std::min(low_db, level.bands_db[band]);
    high_db = std::max(high_db, level.bands_db[band]);
  }
  return range_cell(low_db, high_db);
}

template <typename CellOf>
void add_rows(analysis::Table& table, const study::Study& study, const StimulusLevels& levels,
              std::size_t columns, const CellOf& cell_of) {
  const auto add_row = [&](const std::string& name, const PlaneLevels& plane) {
    std::vector<analysis::Cell> cells{name};
    for (std::size_t i = 0; i < columns; ++i) cells.emplace_back(cell_of(plane, i));
    table.rows.push_back(std::move(cells));
  };
  for (std::size_t i = 0; i < levels.stimuli.size(); ++i) {
    add_row(name_of_stimulus(study, levels.stimuli[i]), levels.levels[i]);
  }
  add_row(kBlank, levels.blank);
}

/// The gain factor at which every stimulus reaches the required level by both curves.
std::string required_gain(const StimulusLevels& levels, const std::string& device) {
  double low_db = 1e9;
  for (const PlaneLevels& plane : levels.levels) {
    low_db = std::min(low_db, simulation::range_on(plane, device).low_db);
  }
  if (low_db <= simulation::kNoLevelDb) return "none";
  return fmt::format("x {:.2f}", std::pow(10.0, (simulation::kMinLevelDb - low_db) / 20.0));
}

analysis::Table level_table(const study::Study& study, const StimulusLevels& levels) {
  analysis::Table table{"levels",
                        levels.simulated_pilots ? "Levels above simulated pilots' threshold, dB"
                        : levels.provisional    ? "Provisional levels above the threshold, dB"
                                                : "Levels above the laboratory's threshold, dB",
                        {{"stimulus", analysis::Align::left}}};
  const std::vector<std::string> devices = devices_of(levels);
  for (const std::string& device : devices) table.columns.push_back({device});
  add_rows(table, study, levels, devices.size(),
           [&](const PlaneLevels& plane, std::size_t i) { return range_cell(plane, devices[i]); });
  std::vector<analysis::Cell> gains{"gain for 10 dB"};
  for (const std::string& device : devices) {
    gains.emplace_back(required_gain(levels, device));
  }
  table.rows.push_back(std::move(gains));
  table.notes = {{levels.simulated_pilots ? kSimulatedPilotNote
                  : levels.provisional    ? kCurveNote
                                          : kPilotNote},
                 {"Gains multiplied by the number in the last row would raise every stimulus to 10 "
                  "dB, as far as motors and stability allow."}};
  if (study.trials.rove_db > 0.0) {
    table.notes.push_back({fmt::format(
        "For the middle of the {:g} dB range over which gains are roved (/trials/rove_db).",
        study.trials.rove_db)});
  }
  if (levels.provisional) table.notes.push_back({kProvisionalNote});
  return table;
}

analysis::Table band_table(const study::Study& study, const StimulusLevels& levels) {
  analysis::Table table{
      "levels-by-band",
      "Power by frequency above the curve, or the blank plane where that is stronger, dB",
      {{"stimulus", analysis::Align::left}}};
  for (const LevelBand& band : simulation::kLevelBands) {
    table.columns.push_back({fmt::format("{:g} to {:g} Hz", band.from_hz, band.to_hz)});
  }
  add_rows(table, study, levels, simulation::kLevelBands.size(), band_cell);
  return table;
}

/// The level of one stimulus minus the level of another on a device, by curve.
std::vector<double> differences_db(const PlaneLevels& one, const PlaneLevels& other,
                                   const std::string& device) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (one[i].device == device) differences.push_back(one[i].db - other[i].db);
  }
  return differences;
}

/// The two stimuli of different classes with the nearest levels, by the curve that separates them
/// best.
std::string nearest_words(const study::Study& study, const StimulusLevels& levels,
                          const std::string& device) {
  double nearest_db = 1e9;
  std::string words;
  for (std::size_t a = 0; a < levels.stimuli.size(); ++a) {
    for (std::size_t b = a + 1; b < levels.stimuli.size(); ++b) {
      if (levels.stimuli[a].class_index == levels.stimuli[b].class_index) continue;
      const std::vector<double> level_differences =
          differences_db(levels.levels[a], levels.levels[b], device);
      double low_db = 1e9;
      double high_db = 0.0;
      for (const double db : level_differences) {
        low_db = std::min(low_db, std::abs(db));
        high_db = std::max(high_db, std::abs(db));
      }
      if (high_db >= nearest_db) continue;
      nearest_db = high_db;
      words =
          fmt::format("{} and {}, {:.1f} to {:.1f} dB", name_of_stimulus(study, levels.stimuli[a]),
                      name_of_stimulus(study, levels.stimuli[b]), low_db, high_db);
    }
  }
  return words;
}

/// The median simulated person's perceived strength of a level, with its noise.
struct StrengthSense {
  double floor;
  double noise;

  StrengthSense() {
    const simulation::SubjectModel person = simulation::default_subject();
    const engine::FeltNoise felt_noise{person.feature_noise, person.common_noise};
    floor = simulation::floor_of(felt_noise, 0.0).floor;
    noise = simulation::strength_noise(felt_noise);
  }
  [[nodiscard]] double strength(double level_db) const {
    return 0.5 * std::log(std::pow(10.0, level_db / 10.0) + floor);
  }
};

/// A stimulus for an observer who judges only by strength.
struct StrengthStimulus {
  double level_db;  ///< at its nominal gain
  int class_index;
};

/// Evenly spaced gains relative to the nominal gain.
std::vector<double> roved_gains_db(double rove_db) {
  constexpr int kGains = 128;
  if (rove_db == 0.0) return {0.0};
  std::vector<double> gains;
  for (int i = 0; i < kGains; ++i) gains.push_back(rove_db * ((i + 0.5) / kGains - 0.5));
  return gains;
}

/// \return the share of right answers by the nearest strength, over the gains that are presented
double accuracy_by_strength(std::vector<StrengthStimulus> stimuli, const StrengthSense& sense,
                            double rove_db) {
  std::ranges::stable_sort(stimuli, {}, &StrengthStimulus::level_db);
  std::vector<double> strengths;
  for (const StrengthStimulus& one : stimuli) strengths.push_back(sense.strength(one.level_db));
  const boost::math::normal normal;
  const std::vector<double> gains_db = roved_gains_db(rove_db);
  double correct = 0.0;
  for (const StrengthStimulus& stimulus : stimuli) {
    for (const double gain_db : gains_db) {
      const double strength = sense.strength(stimulus.level_db + gain_db);
      const auto probability_below = [&](std::size_t edge) {
        if (edge == 0) return 0.0;
        if (edge == stimuli.size()) return 1.0;
        const double middle = 0.5 * (strengths[edge - 1] + strengths[edge]);
        return boost::math::cdf(normal, (middle - strength) / sense.noise);
      };
      for (std::size_t i = 0; i < stimuli.size(); ++i) {
        if (stimuli[i].class_index == stimulus.class_index)
          correct += probability_below(i + 1) - probability_below(i);
      }
    }
  }
  return correct / static_cast<double>(stimuli.size() * gains_db.size());
}

/// The accuracy possible from level alone, by device, curve and method.
struct LevelAccuracy {
  std::string device;
  engine::ThresholdCurve curve;
  int method;
  double accuracy;
};

std::vector<LevelAccuracy> accuracies_by_level(const study::Study& study,
                                               const StimulusLevels& levels) {
  std::vector<LevelAccuracy> accuracies;
  if (study.classes.size() < 2 || !study::chooses_classes(study)) return accuracies;
  const StrengthSense sense;
  for (std::size_t place = 0; place < levels.blank.size(); ++place) {
    for (int method = 0; method < study.presented_methods(); ++method) {
      std::vector<StrengthStimulus> stimuli;
      for (std::size_t i = 0; i < levels.stimuli.size(); ++i) {
        if (levels.stimuli[i].method != method) continue;
        stimuli.push_back({levels.levels[i][place].db, levels.stimuli[i].class_index});
      }
      if (stimuli.empty()) continue;
      accuracies.push_back({levels.blank[place].device, levels.blank[place].curve, method,
                            accuracy_by_strength(std::move(stimuli), sense, study.trials.rove_db)});
    }
  }
  return accuracies;
}

std::string level_accuracy_words(const study::Study& study, const StimulusLevels& levels) {
  const std::vector<LevelAccuracy> all = accuracies_by_level(study, levels);
  std::string words;
  for (const std::string& device : devices_of(levels)) {
    double low = 1.0;
    double high = 0.0;
    for (const LevelAccuracy& one : all) {
      if (one.device != device) continue;
      low = std::min(low, one.accuracy);
      high = std::max(high, one.accuracy);
    }
    if (high < low) continue;
    words += fmt::format("{}{}: {:.0f} to {:.0f} %", words.empty() ? "" : "; ", device, 100.0 * low,
                         100.0 * high);
  }
  if (words.empty()) return words;
  return fmt::format(
      "A simulated person who judged only by strength, not by pattern, would have this share of "
      "right answers (chance {:.0f} %), over curves and methods{}: {}.{}",
      100.0 / static_cast<double>(study.classes.size()),
      study.trials.rove_db > 0.0
          ? fmt::format(", with gains roved over {:g} dB", study.trials.rove_db)
          : "",
      words,
      study.rendering.equalise == engine::Equalise::level
          ? ""
          : " \"equalise\": \"level\" removes that cue.");
}

Json json_of(const PlaneLevels& levels) {
  Json list = Json::array();
  for (const StimulusLevel& level : levels) {
    Json bands = Json::array();
    for (std::size_t band = 0; band < level.bands_db.size(); ++band) {
      bands.push_back({{"from_hz", simulation::kLevelBands[band].from_hz},
                       {"to_hz", simulation::kLevelBands[band].to_hz},
                       {"db", level.bands_db[band]}});
    }
    list.push_back({{"device", level.device},
                    {"curve", engine::name_of(level.curve)},
                    {"db", level.db},
                    {"bands", std::move(bands)}});
  }
  return list;
}

Json json_of_differences(const study::Study& study, const StimulusLevels& levels) {
  Json list = Json::array();
  if (levels.stimuli.size() > kMaxComparedStimuli) return list;
  for (std::size_t a = 0; a < levels.stimuli.size(); ++a) {
    for (std::size_t b = a + 1; b < levels.stimuli.size(); ++b) {
      for (std::size_t i = 0; i < levels.blank.size(); ++i) {
        list.push_back({{"one", name_of_stimulus(study, levels.stimuli[a])},
                        {"other", name_of_stimulus(study, levels.stimuli[b])},
                        {"device", levels.blank[i].device},
                        {"curve", engine::name_of(levels.blank[i].curve)},
                        {"db", levels.levels[a][i].db - levels.levels[b][i].db}});
      }
    }
  }
  return list;
}

Json json_of_level_accuracies(const study::Study& study, const StimulusLevels& levels) {
  Json list = Json::array();
  for (const LevelAccuracy& one : accuracies_by_level(study, levels)) {
    list.push_back({{"device", one.device},
                    {"curve", engine::name_of(one.curve)},
                    {"method", study.methods[static_cast<std::size_t>(one.method)].label},
                    {"right", one.accuracy}});
  }
  return list;
}

Json json_of_all(const study::Study& study, const StimulusLevels& levels) {
  Json stimuli = Json::array();
  for (std::size_t i = 0; i < levels.stimuli.size(); ++i) {
    const study::StimulusIndex& index = levels.stimuli[i];
    stimuli.push_back({{"class", study.classes[index.class_index].label},
                       {"exemplar", index.exemplar + 1},
                       {"method", study.methods[index.method].label},
                       {"levels", json_of(levels.levels[i])}});
  }
  return {{"provisional", levels.provisional},
          {"stimuli", std::move(stimuli)},
          {"blank", json_of(levels.blank)},
          {"differences", json_of_differences(study, levels)},
          {"by_level_alone", json_of_level_accuracies(study, levels)}};
}

/// Whether any session used this device or the model of it.
bool is_used(const std::string& device, const analysis::Collection& collection) {
  const std::string recorded = device == "ideal" ? "simulated" : "simulated " + device;
  return std::ranges::any_of(collection.sessions, [&](const analysis::SessionRecord& session) {
    return session.row.device == recorded || session.row.device == device;
  });
}

/// A sentence for the methods section: the range of levels on each device that was used, over all
/// stimuli and curves.
std::string levels_sentence(const StimulusLevels& levels, const analysis::Collection& collection) {
  const std::vector<std::string> devices = devices_of(levels);
  std::vector<std::string> ranges;
  for (const std::string& device : devices) {
    if (devices.size() > 1 && !is_used(device, collection)) continue;
    double low_db = std::numeric_limits<double>::max();
    double high_db = std::numeric_limits<double>::lowest();
    for (const PlaneLevels& one : levels.levels) {
      const LevelRange range = simulation::range_on(one, device);
      low_db = std::min(low_db, range.low_db);
      high_db = std::max(high_db, range.high_db);
    }
    ranges.push_back(range_cell(low_db, high_db) + " dB on " +
                     (device == "ideal" ? "an ideal device" : device));
  }
  if (ranges.empty() || levels.stimuli.empty()) return {};
  return fmt::format(
      "By models of a hand and of the device, gains were above those at which a stimulus is "
      "distinguished from the blank plane in 79 % of trials with three intervals by {}, {}.",
      listed(ranges),
      levels.provisional ? "over two published curves of thresholds for vibration"
                         : "by thresholds measured in this laboratory");
}

/// Folds every block of the section except warnings.
analysis::Section fold_blocks(analysis::Section section) {
  std::vector<analysis::Block> visible_blocks;
  for (analysis::Block& block : section.blocks) {
    const bool is_warning = std::holds_alternative<analysis::Warnings>(block);
    (is_warning ? visible_blocks : section.folded_blocks).push_back(std::move(block));
  }
  section.blocks = std::move(visible_blocks);
  return section;
}

/// Results with an additional section before the methods.
class ResultsWithSection : public analysis::Results {
 public:
  ResultsWithSection(std::unique_ptr<const analysis::Results> results, analysis::Section section)
      : results_(std::move(results)), section_(std::move(section)) {}

  const analysis::StudyHead& head() const override { return results_->head(); }
  std::vector<analysis::Figure> figures(const std::string& stamp) const override {
    return results_->figures(stamp);
  }
  std::string json() const override { return results_->json(); }
  analysis::Document document(const analysis::Provenance& provenance,
                              const analysis::Pictures& pictures) const override {
    analysis::Document document = results_->document(provenance, pictures);
    const auto methods = std::ranges::find(document.sections, "methods", &analysis::Section::id);
    document.sections.insert(methods, section_);
    return document;
  }

 private:
  std::unique_ptr<const analysis::Results> results_;
  analysis::Section section_;
};

class ResultsWithLevels final : public ResultsWithSection {
 public:
  ResultsWithLevels(std::unique_ptr<const analysis::Results> results, study::Study study,
                    StimulusLevels levels)
      : ResultsWithSection(std::move(results), fold_blocks(levels_section(study, levels))),
        study_(std::move(study)),
        levels_(std::move(levels)) {}

  analysis::Document document(const analysis::Provenance& provenance,
                              const analysis::Pictures& pictures) const override {
    analysis::Document document = ResultsWithSection::document(provenance, pictures);
    analysis::add_to_stimuli(document, levels_sentence(levels_, head().collection));
    return document;
  }
  std::string json() const override {
    Json object = Json::parse(ResultsWithSection::json());
    object["levels"] = json_of_all(study_, levels_);
    return json_text(object);
  }

 private:
  study::Study study_;
  StimulusLevels levels_;
};

}  // namespace

analysis::Section levels_section(const study::Study& study, const StimulusLevels& levels) {
  analysis::Section section{"levels", kTitle, {}};
  const std::vector<std::string> warnings = level_warnings(study, levels);
  if (!warnings.empty()) section.blocks.emplace_back(analysis::Warnings{warnings});
  section.blocks.emplace_back(level_table(study, levels));
  const std::vector<std::string> devices = devices_of(levels);
  if (devices.size() == 1) section.blocks.emplace_back(band_table(study, levels));
  std::string nearest;
  for (const std::string& device : devices) {
    const std::string words = nearest_words(study, levels, device);
    if (!words.empty()) nearest += (nearest.empty() ? "" : "; ") + device + ": " + words;
  }
  if (!nearest.empty()) {
    section.blocks.emplace_back(
        analysis::CitedText{"Smallest difference of level between two classes: " + nearest + "."});
  }
  if (std::string words = level_accuracy_words(study, levels); !words.empty()) {
    section.blocks.emplace_back(analysis::CitedText{std::move(words)});
  }
  return section;
}

std::string levels_json(const PlaneLevels& levels) {
  return json_of(levels).dump();
}

std::string differences_json(const study::Study& study, const StimulusLevels& levels) {
  return json_of_differences(study, levels).dump();
}

std::string all_levels_json(const study::Study& study, const StimulusLevels& levels) {
  return json_of_all(study, levels).dump();
}

std::vector<std::string> level_warnings(const study::Study& study, const StimulusLevels& levels) {
  // A stated level is reached by setting the gains, and a threshold study measures its levels.
  if (study.device.empty() || study.level || !study::chooses_classes(study)) return {};
  const std::string device = devices_of(levels).front();
  std::size_t weak = 0;
  std::size_t weakest = 0;
  const auto high_db = [&](std::size_t i) {
    return simulation::range_on(levels.levels[i], device).high_db;
  };
  for (std::size_t i = 0; i < levels.stimuli.size(); ++i) {
    if (high_db(i) < simulation::kMinLevelDb) ++weak;
    if (high_db(i) < high_db(weakest)) weakest = i;
  }
  if (weak == 0) return {};
  return {
      fmt::format("/rendering/{}: {} of {} stimuli are less than {:g} dB above the threshold on {} "
                  "by either curve, {} {} dB: people may not feel them; {}",
                  study.rendering.gains ? "gains" : "pitch_mm", weak, levels.stimuli.size(),
                  simulation::kMinLevelDb, device, name_of_stimulus(study, levels.stimuli[weakest]),
                  range_cell(levels.levels[weakest], device),
                  study.rendering.gains ? "raise them"
                                        : "double it and filter_mm, with crops of half the side")};
}

std::string range_words(const PlaneLevels& levels) {
  double low_db = 1e9;
  double high_db = -1e9;
  for (const StimulusLevel& level : levels) {
    low_db = std::min(low_db, level.db);
    high_db = std::max(high_db, level.db);
  }
  return range_cell(low_db, high_db);
}

std::unique_ptr<const analysis::Results> with_levels(
    std::unique_ptr<const analysis::Results> results, const study::Study& study,
    StimulusLevels levels) {
  return std::make_unique<ResultsWithLevels>(std::move(results), study, std::move(levels));
}

std::unique_ptr<const analysis::Results> with_levels_note(
    std::unique_ptr<const analysis::Results> results) {
  return std::make_unique<ResultsWithSection>(
      std::move(results),
      analysis::Section{"levels",
                        kTitle,
                        {analysis::CitedText{
                            "Not computed for the terminal, because a simulated hand would have to "
                            "stroke every stimulus on every device; see touchtrial report DB --out "
                            "DIR, or touchtrial prepare."}}});
}

}  // namespace touchtrial::planning
