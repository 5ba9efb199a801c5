#include "protocols/threshold/study/threshold.hpp"

#include "core/random.hpp"
#include "core/strict_json.hpp"
#include "protocols/threshold/study/threshold_section.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::study::threshold {
namespace {

constexpr int kTrackBlock = 0;
constexpr int kControlBlock = 1;

/// How many fields there are for a standard along the order: its own, and one a level.
int fields_of_standard(const ThresholdOptions& options) {
  return 1 + static_cast<int>(options.track.levels.size());
}

/// Draws the trials of one participant. A trial's draws depend on its number, and on how often it
/// was interrupted, so that a repeated one has another answer.
class TrialDraw {
 public:
  TrialDraw(const Study& study, const Digest& secret) : study_(study), secret_(secret) {}

  /// Fills a trial at the highest level of a standard that is drawn.
  void fill_easily(Presentation& place, std::string_view purpose, std::uint64_t index,
                   RandomStream& random) const {
    const std::vector<Standard> standards = standards_of(study_);
    const auto nth = static_cast<std::size_t>(random.below(standards.size()));
    const std::size_t top = levels_of(options_of(study_), standards[nth]).size() - 1;
    place.chosen = {0, static_cast<int>(top), 0};
    fill(place, purpose, index, nth, top);
  }

  /// Fills the intervals, and sets the target.
  void fill(Presentation& place, std::string_view purpose, std::uint64_t index,
            std::size_t nth_standard, std::size_t level) const {
    const ThresholdOptions& options = options_of(study_);
    RandomStream random(secret_, purpose, index);
    const auto choices = static_cast<std::uint64_t>(
        options.question == Question::same_different ? 2 : options.intervals);
    const auto target = static_cast<int>(random.below(choices));
    const bool swapped = random.below(2) == 1;
    const Interval reference = interval_at(study_, nth_standard, std::nullopt);
    const Interval signal = interval_at(study_, nth_standard, level);
    place.chosen->target = target;
    place.intervals.clear();
    for (int i = 0; i < options.intervals; ++i) {
      place.intervals.push_back(has_signal(i, target, swapped) ? signal : reference);
      vary(place.intervals.back(), random);
    }
  }

 private:
  [[nodiscard]] bool has_signal(int interval, int target, bool swapped) const {
    switch (options_of(study_).question) {
      case Question::which_interval:
        return interval == target;
      case Question::odd_one_out:
        return (interval == target) != swapped;  // either is odd equally often
      case Question::same_different:
        return target == 0 ? swapped : (interval == 1) != swapped;
    }
    return false;
  }

  /// Draws exemplar and gain.
  void vary(Interval& interval, RandomStream& random) const {
    const ThresholdOptions& options = options_of(study_);
    const auto exemplar_of = [&](const StimulusIndex& of) {
      const auto images = study_.classes[static_cast<std::size_t>(of.class_index)].images.size();
      return static_cast<int>(random.below(images));
    };
    interval.stimulus.exemplar = exemplar_of(interval.stimulus);
    if (interval.other) interval.other->exemplar = exemplar_of(*interval.other);
    const double rove_db = drawn_rove_db(options.rove_db, random);
    if (interval.blank || options.rove_db == 0.0) return;
    interval.gain_db += rove_db;
    if (options.along != Along::gain) interval.gain_db -= options.rove_db / 2.0;
  }

  const Study& study_;
  Digest secret_;
};

class ThresholdOrder final : public AdaptiveOrder {
 public:
  ThresholdOrder(const Study& study, const ScheduleDraw& draw)
      : study_(study),
        trials_(study_, block_secret(draw)),
        catches_(block_secret(draw)),
        block_(block_settings(study_), block_secret(draw)) {}

  void choose(Presentation& place) const override {
    const ThresholdOptions& options = options_of(study_);
    const auto tracks_each = static_cast<std::size_t>(options.tracks_each);
    constexpr std::uint64_t kMaxTrials = 1U << 20U;
    const auto index = static_cast<std::uint64_t>(place.trial) +
                       kMaxTrials * static_cast<std::uint64_t>(place.interruptions);
    const std::optional<procedures::Presentation> next = block_.next();
    if (next && next->track) {
      place.role = Role::scored;
      place.chosen = {static_cast<int>(*next->track) + 1, static_cast<int>(next->level), 0};
      return trials_.fill(place, "threshold: trial", index, *next->track / tracks_each,
                          next->level);
    }
    place.role = next ? Role::catch_trial : Role::control;
    RandomStream random(catches_, "threshold: standard", index);
    trials_.fill_easily(place, "threshold: trial", index, random);
  }

  void answer(const Presentation& shown, int choice) override {
    if (!shown.hand_off) block_.answer(choice == shown.chosen->target);
  }

 private:
  Study study_;
  TrialDraw trials_;
  Digest catches_;
  procedures::Block block_;
};

std::string question_key(const ThresholdOptions& options) {
  if (options.question == Question::odd_one_out) return "threshold_odd";
  if (options.question == Question::same_different) return "threshold_same";
  if (options.task == Task::detection) return "threshold_texture";
  return options.along == Along::pitch ? "threshold_coarser" : "threshold_stronger";
}

class Threshold final : public Protocol {
 public:
  std::string_view name() const noexcept override { return "threshold"; }
  std::string_view section() const noexcept override { return "threshold"; }
  int least_classes() const noexcept override { return 1; }

  std::shared_ptr<const ProtocolOptions> read(
      const std::optional<JsonValue>& section) const override {
    if (section) return read_section(*section);
    return std::make_shared<ThresholdOptions>();
  }
  std::string options_in_clear(const Study& study) const override {
    return section_json(options_of(study));
  }
  /// Along the order, every level needs a field of its own.
  void complete(const JsonValue& file, Study& study) const override {
    const ThresholdOptions& options = options_of(study);
    if (options.track.levels.empty()) {
      file.refuse_below("/threshold", "is missing; a threshold needs at least task and levels");
    }
    if (study.methods.size() != 1) {
      file.refuse_below("/methods", fmt::format("has {} entries; a threshold is of one method",
                                                study.methods.size()));
    }
    if (options.along != Along::order) return;
    const StudyMethod own = study.methods.front();
    if (own.method != engine::Method::fixed) {
      file.refuse_below("/methods/0/name", "must be \"fixed\", whose order the levels change");
    }
    study.methods.clear();
    for (const double standard : options.standards) {
      const auto add = [&](double order) {
        StudyMethod& made = study.methods.emplace_back(own);
        made.order = order;
        made.label = fmt::format("order {}-{:.5f}", study.methods.size(), order);
      };
      add(standard);
      for (const double level : options.track.levels) {
        const double order = comparison_at(options, {0, standard}, level);
        add(std::min(order, std::nextafter(1.0, 0.0)));  // refused by `check` with its place
      }
    }
  }
  void check(const JsonValue& file, const Study& study) const override {
    check_section(file, study);
  }
  int scored_trials(const Study& study) const override {
    const ThresholdOptions& options = options_of(study);
    return static_cast<int>(standards_of(study).size()) * options.tracks_each *
           options.track.trials;
  }
  Schedule schedule(const Study& study, const ScheduleDraw& /*draw*/) const override {
    const ThresholdOptions& options = options_of(study);
    const int of_tracks = scored_trials(study) + options.catch_trials;
    Schedule schedule;
    for (int i = 0; i < of_tracks + options.control_trials; ++i) {
      Presentation& place = schedule.presentations.emplace_back();
      place.trial = i + 1;
      if (i < of_tracks) continue;
      place.block = kControlBlock;
      place.role = Role::control;
      place.hand_off = true;
    }
    schedule.layout.resize(choices(study).size());
    std::iota(schedule.layout.begin(), schedule.layout.end(), 0);
    return schedule;
  }
  std::string rule(const Study& study) const override {
    return "touchtrial threshold 1: levels by the procedure's answers, ties within 1e-9 to the "
           "smallest; draws by BLAKE2b(participant's secret, purpose, trial); " +
           section_json(options_of(study));
  }
  std::unique_ptr<AdaptiveOrder> adaptive_order(const Study& study,
                                                const ScheduleDraw& draw) const override {
    return std::make_unique<ThresholdOrder>(study, draw);
  }
  StimulusIndex stimulus_of(const Study& study, const ChosenLevel& chosen) const override {
    const ThresholdOptions& options = options_of(study);
    const int standard = std::max(0, chosen.track - 1) / options.tracks_each;
    const auto nth = std::min(static_cast<std::size_t>(standard), standards_of(study).size() - 1);
    const auto top = options.track.levels.size() - 1;
    return interval_at(study, nth,
                       std::min(static_cast<std::size_t>(std::max(0, chosen.level)), top))
        .stimulus;
  }
  std::vector<Choice> choices(const Study& study) const override {
    const ThresholdOptions& options = options_of(study);
    if (options.question == Question::same_different) return {{"same"}, {"different"}};
    std::vector<Choice> all = {{"first"}, {"second"}};
    if (options.intervals == 3) all.push_back({"third"});
    return all;
  }
  std::optional<int> right_choice(const Study& /*study*/,
                                  const Presentation& shown) const override {
    if (!shown.chosen) return std::nullopt;
    return shown.chosen->target;
  }
  std::optional<IntervalPlan> interval_plan(const Study& study) const override {
    const ThresholdOptions& options = options_of(study);
    return IntervalPlan{.count = options.intervals,
                        .seconds = options.interval_s,
                        .windows = options.windows,
                        .question = question_key(options),
                        .feedback = options.feedback,
                        .practice_criterion = options.practice_criterion,
                        .practice_rounds = options.practice_rounds};
  }
  std::vector<Interval> mixtures(const Study& study) const override {
    const ThresholdOptions& options = options_of(study);
    std::vector<Interval> all;
    if (options.along != Along::blend) return all;
    for (std::size_t level = 0; level < options.track.levels.size(); ++level) {
      const Interval mixed = interval_at(study, 0, level);
      for (std::size_t a = 0; a < study.classes[0].images.size(); ++a) {
        for (std::size_t b = 0; b < study.classes[1].images.size(); ++b) {
          Interval& one = all.emplace_back(mixed);
          one.stimulus.exemplar = static_cast<int>(a);
          one.other->exemplar = static_cast<int>(b);
        }
      }
    }
    return all;
  }
  std::vector<Presentation> practice_trials(const Study& study, const ScheduleDraw& draw,
                                            int round) const override {
    const ThresholdOptions& options = options_of(study);
    const TrialDraw trials(study, block_secret(draw));
    std::vector<Presentation> all(static_cast<std::size_t>(options.practice_trials));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto index = static_cast<std::uint64_t>(round) * 1000 + i;
      RandomStream random(block_secret(draw), "threshold: practice standard", index);
      all[i].trial = static_cast<int>(i) + 1;
      trials.fill_easily(all[i], "threshold: practice", index, random);
    }
    return all;
  }
};

}  // namespace

const ThresholdOptions& options_of(const Study& study) {
  return static_cast<const ThresholdOptions&>(*study.options);
}

const Protocol& protocol() {
  static const Threshold protocol;
  return protocol;
}

std::vector<Standard> standards_of(const Study& study) {
  const ThresholdOptions& options = options_of(study);
  const std::size_t classes = options.along == Along::blend ? 1 : study.classes.size();
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
    case Along::gain:
      if (options.task == Task::detection) return label;
      return fmt::format("{}, standard {} dB", label, number_text(standard.value));
    case Along::order:
      return fmt::format("{}, order {}", label, number_text(standard.value));
    case Along::blend:
      return label + " to " + study.classes.back().label;
    case Along::pitch:
      break;
  }
  return label;
}

Interval interval_at(const Study& study, std::size_t nth_standard,
                     std::optional<std::size_t> level) {
  const ThresholdOptions& options = options_of(study);
  const Standard standard = standards_of(study)[nth_standard];
  Interval interval;
  interval.stimulus.class_index = standard.class_index;
  const double at = level ? options.track.levels[*level] : 0.0;
  const double amount = level ? comparison_at(options, standard, at) : standard.value;
  switch (options.along) {
    case Along::gain:
      interval.blank = options.task == Task::detection && !level;
      interval.gain_db = interval.blank ? 0.0 : amount;
      break;
    case Along::pitch:
      interval.pitch_factor = level ? amount : 1.0;
      break;
    case Along::order:
      interval.stimulus.method =
          static_cast<int>(nth_standard % options.standards.size()) * fields_of_standard(options) +
          (level ? 1 + static_cast<int>(*level) : 0);
      break;
    case Along::blend:
      interval.other = StimulusIndex{1, 0, 0};
      interval.share = level ? std::min(amount, 1.0) : 0.0;
      break;
  }
  return interval;
}

std::vector<double> levels_of(const ThresholdOptions& options, const Standard& standard) {
  constexpr double kRounding = 1e-9;
  std::vector<double> own = options.track.levels;
  if (options.along != Along::gain) return own;
  std::erase_if(own, [&](double level) {
    return comparison_at(options, standard, level) + options.rove_db / 2.0 > kRounding;
  });
  return own;
}

procedures::BlockSettings block_settings(const Study& study) {
  const ThresholdOptions& options = options_of(study);
  procedures::BlockSettings block{{}, options.catch_trials};
  for (const Standard& standard : standards_of(study)) {
    procedures::TrackSettings track = options.track;
    track.levels = levels_of(options, standard);
    if (track.levels.empty()) throw std::invalid_argument("a standard has no level");
    track.up_down.first_level = std::min(track.up_down.first_level, track.levels.size() - 1);
    block.tracks.insert(block.tracks.end(), static_cast<std::size_t>(options.tracks_each), track);
  }
  return block;
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
    case Along::gain:
      return standard.value + kDbPerDecade * std::log10(1.0 + change);
    case Along::order:
      return standard.value * (1.0 + change);
    case Along::blend:
      return change;
    case Along::pitch:
      break;
  }
  return 1.0 + change;
}

std::string unit_of_level(const ThresholdOptions& options) {
  return options.task == Task::detection ? "dB re the pack's gain" : "20 log10 of the difference";
}

}  // namespace touchtrial::study::threshold
