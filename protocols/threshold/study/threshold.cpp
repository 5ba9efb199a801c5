#include "protocols/threshold/study/threshold.hpp"

#include "core/random.hpp"
#include "core/strict_json.hpp"
#include "protocols/threshold/study/registered_standards.hpp"
#include "protocols/threshold/study/threshold_section.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::study::threshold {
namespace {

constexpr int kControlBlock = 1;

/// The number of fields per standard along the order: one for the standard and one per level.
int fields_of_standard(const ThresholdOptions& options) {
  return 1 + static_cast<int>(options.track.levels.size());
}

/// Draws one participant's trials. The draws depend on the trial's number and its number of
/// interruptions, so that a repeated trial has a new right answer.
class TrialDraw {
 public:
  TrialDraw(const Study& study, const Digest& secret) : study_(study), secret_(secret) {}

  /// Sets a trial to the highest level of a random standard.
  void fill_at_highest_level(Trial& trial, std::string_view purpose, std::uint64_t index,
                             RandomStream& random) const {
    const std::vector<Standard> standards = standards_of(study_);
    const auto standard = static_cast<std::size_t>(random.below(standards.size()));
    const std::size_t highest_level = levels_of(options_of(study_), standards[standard]).size() - 1;
    trial.level = {0, static_cast<int>(highest_level)};
    fill_planes(trial, purpose, index, standard, highest_level);
  }

  void fill_planes(Trial& trial, std::string_view purpose, std::uint64_t index,
                   std::size_t standard_index, std::size_t level) const {
    const ThresholdOptions& options = options_of(study_);
    RandomStream random(secret_, purpose, index);
    const auto choices = static_cast<std::uint64_t>(
        options.question == Question::same_different ? 2 : options.intervals);
    const auto target = static_cast<int>(random.below(choices));
    const bool is_swapped = random.below(2) == 1;
    const Plane reference = plane_at(study_, standard_index, std::nullopt);
    const Plane signal = plane_at(study_, standard_index, level);
    trial.right = target;
    trial.planes.clear();
    for (int i = 0; i < options.intervals; ++i) {
      trial.planes.push_back(has_signal(i, target, is_swapped) ? signal : reference);
      draw_exemplar_and_gain(trial.planes.back(), random);
    }
  }

 private:
  [[nodiscard]] bool has_signal(int interval, int target, bool is_swapped) const {
    switch (options_of(study_).question) {
      case Question::which_interval:
        return interval == target;
      case Question::odd_one_out:
        return (interval == target) != is_swapped;  // each kind is odd equally often
      case Question::same_different:
        return target == 0 ? is_swapped : (interval == 1) != is_swapped;
    }
    return false;
  }

  void draw_exemplar_and_gain(Plane& plane, RandomStream& random) const {
    const ThresholdOptions& options = options_of(study_);
    const auto draw_exemplar = [&](const StimulusIndex& stimulus) {
      const auto images =
          study_.classes[static_cast<std::size_t>(stimulus.class_index)].images.size();
      return static_cast<int>(random.below(images));
    };
    plane.field.exemplar = draw_exemplar(plane.field);
    if (plane.mix) plane.mix->other.exemplar = draw_exemplar(plane.mix->other);
    const double rove_db = draw_rove_db(options.rove_db, random);
    if (plane.blank || options.rove_db == 0.0) return;
    plane.gain_db += rove_db;
    if (options.along != LevelQuantity::gain) plane.gain_db -= options.rove_db / 2.0;
  }

  const Study& study_;
  Digest secret_;
};

/// A schedule with the places of the tracks' trials, then the places of the control trials.
Schedule empty_schedule(const Study& study) {
  const ThresholdOptions& options = options_of(study);
  const int track_trials = study.task->scored_trials(study) + options.catch_trials;
  Schedule schedule;
  for (int i = 0; i < track_trials + options.control_trials; ++i) {
    Trial& trial = schedule.trials.emplace_back();
    trial.place.trial = i + 1;
    if (i < track_trials) continue;
    trial.place.block = kControlBlock;
    trial.place.hand_off = true;
    trial.role = Role::control;
  }
  schedule.layout.resize(choices_of(study).size());
  std::iota(schedule.layout.begin(), schedule.layout.end(), 0);
  return schedule;
}

class ThresholdOrder final : public Order {
 public:
  ThresholdOrder(const Study& study, const ScheduleDraw& draw)
      : Order(empty_schedule(study), draw.secret),
        study_(study),
        trials_(study_, block_secret(draw)),
        controls_(block_secret(draw)),
        block_(block_settings(study_), block_secret(draw)) {}

  Trial at(const Trial& scheduled) const override {
    const ThresholdOptions& options = options_of(study_);
    const auto tracks_each = static_cast<std::size_t>(options.tracks_each);
    constexpr std::uint64_t kMaxTrials = 1U << 20U;
    const auto interruptions = interruptions_.find(scheduled.place.trial);
    const auto index =
        static_cast<std::uint64_t>(scheduled.place.trial) +
        kMaxTrials * (interruptions == interruptions_.end() ? 0 : interruptions->second);
    Trial trial = scheduled;
    const std::optional<procedures::Presentation> next = block_.next();
    if (next) {
      trial.role = next->is_catch ? Role::catch_trial : Role::scored;
      trial.level = {static_cast<int>(next->track) + 1, static_cast<int>(next->level)};
      trials_.fill_planes(trial, "threshold: trial", index, next->track / tracks_each, next->level);
      return trial;
    }
    trial.role = Role::control;
    RandomStream random(controls_, "threshold: standard", index);
    trials_.fill_at_highest_level(trial, "threshold: trial", index, random);
    return trial;
  }

  void answered(const Trial& shown, const Answer& answer) override {
    if (!shown.place.hand_off) block_.answer(schedule().choice_of(answer) == shown.right);
  }
  void interrupted(const Trial& shown) override { ++interruptions_[shown.place.trial]; }

 private:
  const Study& study_;
  TrialDraw trials_;
  Digest controls_;
  procedures::Block block_;
  std::map<int, std::uint64_t> interruptions_;  ///< by trial
};

std::string question_key(const ThresholdOptions& options) {
  if (options.question == Question::odd_one_out) return "threshold_odd";
  if (options.question == Question::same_different) return "threshold_same";
  if (options.task == Task::detection) return "threshold_texture";
  return options.along == LevelQuantity::pitch ? "threshold_coarser" : "threshold_stronger";
}

class ThresholdTask final : public study::Task {
 public:
  explicit ThresholdTask(ThresholdOptions options) : options_(std::move(options)) {}

  [[nodiscard]] const ThresholdOptions& options() const noexcept { return options_; }

  void check(const JsonValue& file, const Study& study) const override {
    if (options_.track.levels.empty()) {
      file.refuse_below("/threshold", "is missing; add it with at least task and levels");
    }
    if (study.methods.size() != 1) {
      file.refuse_below("/methods",
                        fmt::format("has {} entries, but the protocol threshold uses one "
                                    "method; remove the others",
                                    study.methods.size()));
    }
    if (options_.along == LevelQuantity::order &&
        study.methods.front().method != engine::Method::fixed) {
      file.refuse_below("/methods/0/name",
                        "must be \"fixed\" for levels along the order, which no other method has");
    }
    check_section(file, study);
    check_registered(file, study);
  }
  std::string plaintext_settings() const override { return section_json(options_); }
  std::string rule(const Study& /*study*/) const override {
    return "touchtrial threshold 2: levels by the procedure's answers, ties within 1e-9 to the "
           "smallest; catch trials dealt evenly to tracks, at their highest level; draws by "
           "BLAKE2b(participant's secret, purpose, trial); " +
           section_json(options_);
  }
  std::vector<std::string> advice(const Study& study) const override {
    const int missing = missing_catch_trials(study);
    if (missing == 0) return {};
    return {fmt::format(
        "/threshold/catch: {} catch trials are too few to distinguish lapses from a higher "
        "threshold, so thresholds of people who lapse will be biased; use {}",
        options_.catch_trials, options_.catch_trials + missing)};
  }
  int scored_trials(const Study& study) const override {
    return static_cast<int>(standards_of(study).size()) * options_.tracks_each *
           options_.track.trials;
  }
  int answered_catches(const Study& /*study*/) const override { return options_.catch_trials; }
  Fields fields(const Study& study) const override {
    return {.methods = methods(study.methods.front()),
            .mixtures = mixtures(study),
            .has_equal_heights = true};
  }

  TrialQuestion ask(const Study& study, const Place& place) const override {
    TrialQuestion question{.exploring = TimedContact{options_.interval_s, options_.windows},
                           .planes = options_.intervals,
                           .question = ChoiceQuestion{question_key(options_), choices()},
                           .confidence_levels = study.session.confidence_levels,
                           .feedback = options_.feedback && !place.hand_off};
    if (place.hand_off) question.exploring = PlayedStroke{options_.interval_s};
    return question;
  }
  std::unique_ptr<Order> order(const Study& study, const ScheduleDraw& draw) const override {
    return std::make_unique<ThresholdOrder>(study, draw);
  }
  Practice practice(const Study& study, const ScheduleDraw& draw, int round) const override {
    const TrialDraw trials(study, block_secret(draw));
    Practice practice{
        .labels = {},
        .trials = std::vector<Trial>(static_cast<std::size_t>(options_.practice_trials)),
        .criterion = options_.practice_criterion,
        .rounds = options_.practice_rounds};
    for (const Choice& choice : choices()) practice.labels.push_back(choice.label);
    for (std::size_t i = 0; i < practice.trials.size(); ++i) {
      const auto index = static_cast<std::uint64_t>(round) * 1000 + i;
      RandomStream random(block_secret(draw), "threshold: practice standard", index);
      practice.trials[i].place.trial = static_cast<int>(i) + 1;
      practice.trials[i].role = Role::practice;
      trials.fill_at_highest_level(practice.trials[i], "threshold: practice", index, random);
    }
    return practice;
  }
  StimulusIndex threshold_field(const Study& study, const Level& level) const override {
    const int standard = std::max(0, level.track - 1) / options_.tracks_each;
    const auto index = std::min(static_cast<std::size_t>(standard), standards_of(study).size() - 1);
    const auto highest_level = options_.track.levels.size() - 1;
    return plane_at(study, index,
                    std::min(static_cast<std::size_t>(std::max(0, level.level)), highest_level))
        .field;
  }

 private:
  [[nodiscard]] std::vector<Choice> choices() const {
    if (options_.question == Question::same_different) return {{"same"}, {"different"}};
    std::vector<Choice> all = {{"first"}, {"second"}};
    if (options_.intervals == 3) all.push_back({"third"});
    return all;
  }
  /// If levels lie along the order, every level needs its own field and therefore its own method.
  /// \param base  the study file's method, or a method that this function returned
  [[nodiscard]] std::vector<StudyMethod> methods(const StudyMethod& base) const {
    if (options_.along != LevelQuantity::order) return {base};
    std::vector<StudyMethod> all;
    const auto add = [&](double order) {
      StudyMethod& method = all.emplace_back(base);
      method.order = std::min(order, std::nextafter(1.0, 0.0));  // `check` refuses larger orders
      method.label = fmt::format("order {}-{:.5f}", all.size(), method.order);
    };
    for (const double standard : options_.standards) {
      add(standard);
      for (const double level : options_.track.levels) {
        add(comparison_at(options_, {0, standard}, level));
      }
    }
    return all;
  }
  [[nodiscard]] std::vector<Plane> mixtures(const Study& study) const {
    std::vector<Plane> all;
    if (options_.along != LevelQuantity::blend) return all;
    for (std::size_t level = 0; level < options_.track.levels.size(); ++level) {
      const Plane mixture = plane_at(study, 0, level);
      for (std::size_t a = 0; a < study.classes[0].images.size(); ++a) {
        for (std::size_t b = 0; b < study.classes[1].images.size(); ++b) {
          Plane& plane = all.emplace_back(mixture);
          plane.field.exemplar = static_cast<int>(a);
          plane.mix->other.exemplar = static_cast<int>(b);
        }
      }
    }
    return all;
  }

  ThresholdOptions options_;
};

std::shared_ptr<const study::Task> read_task(const std::optional<JsonValue>& section) {
  return std::make_shared<ThresholdTask>(section ? read_section(*section) : ThresholdOptions{});
}

constexpr Estimand kEstimands[] = {Estimand::mean_threshold, Estimand::threshold_difference,
                                   Estimand::threshold_equality};

}  // namespace

const ThresholdOptions& options_of(const Study& study) {
  return static_cast<const ThresholdTask&>(*study.task).options();
}

Study with_options(const Study& study, const ThresholdOptions& options) {
  Study changed = study;
  changed.task = std::make_shared<ThresholdTask>(options);
  return changed;
}

const Protocol& protocol() {
  static constexpr Protocol kProtocol{.name = "threshold",
                                      .section = "threshold",
                                      .read = read_task,
                                      .min_classes = 1,
                                      .adaptive = true,
                                      .section_schema = section_schema,
                                      .estimands = kEstimands};
  return kProtocol;
}

std::vector<Standard> standards_of(const Study& study) {
  const ThresholdOptions& options = options_of(study);
  const std::size_t classes = options.along == LevelQuantity::blend ? 1 : study.classes.size();
  std::vector<Standard> all;
  for (std::size_t c = 0; c < classes; ++c) {
    for (const double value : options.standards) all.push_back({static_cast<int>(c), value});
  }
  return all;
}

std::string words_of(const Study& study, const Standard& standard) {
  const ThresholdOptions& options = options_of(study);
  const std::string& label = study.classes[static_cast<std::size_t>(standard.class_index)].label;
  switch (options.along) {
    case LevelQuantity::gain:
      if (options.task == Task::detection) return label;
      return fmt::format("{}, standard {} dB", label, number_text(standard.value));
    case LevelQuantity::order:
      return fmt::format("{}, order {}", label, number_text(standard.value));
    case LevelQuantity::blend:
      return label + " to " + study.classes.back().label;
    case LevelQuantity::pitch:
      break;
  }
  return label;
}

Plane plane_at(const Study& study, std::size_t standard_index, std::optional<std::size_t> level) {
  const ThresholdOptions& options = options_of(study);
  const Standard standard = standards_of(study)[standard_index];
  Plane plane;
  plane.field.class_index = standard.class_index;
  const double amount =
      level ? comparison_at(options, standard, options.track.levels[*level]) : standard.value;
  switch (options.along) {
    case LevelQuantity::gain:
      plane.blank = options.task == Task::detection && !level;
      plane.gain_db = plane.blank ? 0.0 : amount;
      break;
    case LevelQuantity::pitch:
      plane.pitch = level ? amount : 1.0;
      break;
    case LevelQuantity::order:
      plane.field.method = static_cast<int>(standard_index % options.standards.size()) *
                               fields_of_standard(options) +
                           (level ? 1 + static_cast<int>(*level) : 0);
      break;
    case LevelQuantity::blend:
      plane.mix = Mix{{1, 0, 0}, level ? std::min(amount, 1.0) : 0.0};
      break;
  }
  return plane;
}

std::vector<double> levels_of(const ThresholdOptions& options, const Standard& standard) {
  constexpr double kRounding = 1e-9;
  std::vector<double> levels = options.track.levels;
  if (options.along != LevelQuantity::gain) return levels;
  std::erase_if(levels, [&](double level) {
    return comparison_at(options, standard, level) + options.rove_db / 2.0 > kRounding;
  });
  return levels;
}

procedures::BlockSettings block_settings(const Study& study) {
  const ThresholdOptions& options = options_of(study);
  procedures::BlockSettings block{{}, options.catch_trials};
  for (const Standard& standard : standards_of(study)) {
    procedures::TrackSettings track = options.track;
    track.levels = levels_of(options, standard);
    if (track.levels.empty())
      throw std::invalid_argument("block_settings: a standard has no level");
    track.up_down.first_level = std::min(track.up_down.first_level, track.levels.size() - 1);
    block.tracks.insert(block.tracks.end(), static_cast<std::size_t>(options.tracks_each), track);
  }
  return block;
}

int missing_catch_trials(const Study& study) {
  constexpr int kMinCatchTrials = 6;
  const ThresholdOptions& options = options_of(study);
  if (options.question == Question::same_different) return 0;
  const procedures::BlockSettings block = block_settings(study);
  int missing_per_track = 0;
  for (const procedures::TrackSettings& track : block.tracks) {
    const int trials_at_highest = track.procedure == "constant-stimuli"
                                      ? track.trials / static_cast<int>(track.levels.size())
                                      : 0;
    const int required = std::max(kMinCatchTrials, (track.trials + 9) / 10);
    missing_per_track =
        std::max(missing_per_track, std::min(required, track.trials / 2) - trials_at_highest);
  }
  const int total = missing_per_track * static_cast<int>(block.tracks.size());
  return std::max(0, total - block.catch_trials);
}

Digest block_secret(const ScheduleDraw& draw) {
  return FieldHasher(HashFunction::blake2b)
      .add("threshold: block")
      .add(ByteView(draw.secret))
      .add(draw.visit)
      .finish();
}

double comparison_at(const ThresholdOptions& options, const Standard& standard, double level) {
  constexpr double kDbPerDecade = 20.0;
  if (options.task == Task::detection) return level;
  const double change = std::pow(10.0, level / kDbPerDecade);
  switch (options.along) {
    case LevelQuantity::gain:
      return standard.value + kDbPerDecade * std::log10(1.0 + change);
    case LevelQuantity::order:
      return standard.value * (1.0 + change);
    case LevelQuantity::blend:
      return change;
    case LevelQuantity::pitch:
      break;
  }
  return 1.0 + change;
}

std::string unit_of_level(const ThresholdOptions& options) {
  return options.task == Task::detection ? "dB re the pack's gain" : "20 log10 of the difference";
}

}  // namespace touchtrial::study::threshold
