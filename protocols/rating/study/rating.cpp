#include "protocols/rating/study/rating.hpp"

#include "core/strict_json.hpp"
#include "study/languages.hpp"
#include "study/random_orders.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::study::rating {
namespace {

constexpr const char* kDefaultScale = "fit";  ///< the scale that has texts in the language files

void describe_translated_text(ObjectIo& io, std::string_view key, Translated& words,
                              const KeyInfo& about) {
  io.member(key, about, true, [&words](ValueIo& value) { describe_translated(value, words); });
}

void describe_scale(ObjectIo& io, RatedScale& scale) {
  io.text("id", scale.id, kPlainName,
          {.meaning = "a plain name, unique; it names the scale's column in exports",
           .required = true});
  io.rule([&scale](const JsonValue& /*place*/, const JsonObject& object) {
    if (scale.id == kDefaultScale) return;
    for (const char* key : {"text", "low", "high"}) static_cast<void>(object.at(key));
  });
  describe_translated_text(
      io, "text", scale.text,
      {.meaning = "the question, by language, including the study's; for the scale "
                  "`fit`, question and end labels default to the program's",
       .range = "by language"});
  describe_translated_text(io, "low", scale.low,
                           {.meaning = "label of the low end", .range = "by language"});
  describe_translated_text(io, "high", scale.high,
                           {.meaning = "label of the high end", .range = "by language"});
  io.integer("points", scale.points, 0, kMaxPoints,
             {.meaning = "2 to 11: numbers from 1; 0: a line from 0 to 1, in steps of .001",
              .range = "0, 2 to 11"});
  io.rule([&scale](const JsonValue& place, const JsonObject& /*object*/) {
    if (scale.points == 1) place.refuse_below("/points", "is 1; use 0 for a line, or 2 to 11");
  });
}

void describe(ObjectIo& io, RatingOptions& options) {
  io.list("scales", options.scales, {.min = 1, .max = kMaxScales},
          {.meaning = "the scales, all asked in each trial",
           .default_text = "`fit` alone",
           .range = "1 to 6 entries"},
          [](ValueIo& value, RatedScale& scale) { value.part(scale, describe_scale); });
  io.rule([&options](const JsonValue& place, const JsonObject& /*object*/) {
    const std::vector<RatedScale>& scales = options.scales;
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const auto previous = std::span(scales).first(i);
      if (std::ranges::count(previous, scales[i].id, &RatedScale::id) == 0) continue;
      place.refuse_below(
          fmt::format("/scales/{}/id", i),
          in_quotes(scales[i].id) + " is the id of another scale; ids must be unique");
    }
  });
  io.boolean("anchors", options.anchors,
             {"practice begins with examples of the scale's ends: a plane without texture, then a "
              "texture with its own picture"});
}

std::string section_schema() {
  RatingOptions defaults;
  return annotated_section({.meaning = "the scales of the protocol `rating`: "
                                       "[rating.md](rating.md)",
                            .default_text = "one scale, `fit`"},
                           [&defaults](ObjectIo& io) { describe(io, defaults); });
}

/// Chooses a class's images in random order; all are used before any repeats.
class ImageDeck {
 public:
  explicit ImageDeck(std::size_t images) : images_(images) {}

  int next(RandomStream& random) {
    if (remaining_.empty()) {
      remaining_.resize(images_);
      std::iota(remaining_.begin(), remaining_.end(), 0);
      shuffle(std::span<int>(remaining_), random);
    }
    const int image = remaining_.back();
    remaining_.pop_back();
    return image;
  }

 private:
  std::size_t images_;
  std::vector<int> remaining_;
};

Trial rated_trial(int class_index, int block) {
  Trial trial;
  trial.place.block = block;
  trial.planes.push_back({.field = {class_index, 0, 0}});
  trial.picture = class_index;
  return trial;
}

/// Draws a pass: every texture once with each of these methods, in random order.
std::vector<Trial> draw_pass(const Study& study, int block, const std::vector<int>& methods,
                             RandomStream& random, std::vector<ImageDeck>& decks) {
  std::vector<Trial> trials;
  for (int i = 0; i < static_cast<int>(study.classes.size()); ++i) {
    for (const int method : methods) {
      Trial& trial = trials.emplace_back(rated_trial(i, block));
      Plane& plane = trial.planes.front();
      plane.field.method = method;
      plane.field.exemplar = decks[static_cast<std::size_t>(i)].next(random);
      if (study.trials.rove_db == 0.0) continue;
      plane.gain_db = study.trials.centre_gain_db() + draw_rove_db(study.trials.rove_db, random);
    }
  }
  shuffle(std::span<Trial>(trials), random);
  return trials;
}

std::vector<Trial> draw_block(const Study& study, const ScheduleDraw& draw, int block,
                              RandomStream& random, std::vector<ImageDeck>& decks) {
  const bool is_by_method = study.trials.blocks == Blocks::by_method;
  std::vector<int> methods = williams_row(study.presented_methods(), draw.method_order);
  if (is_by_method) methods = {methods[static_cast<std::size_t>(block)]};
  std::vector<Trial> trials;
  for (int pass = 0; pass < (is_by_method ? study.trials.repeats : 1); ++pass) {
    std::ranges::move(draw_pass(study, block, methods, random, decks), std::back_inserter(trials));
  }
  return trials;
}

/// Inserts planes without texture at random places except the first, each with the picture of a
/// random class.
void add_catch_trials(const Study& study, int count, RandomStream& random,
                      std::vector<Trial>& trials) {
  for (int i = 0; i < count; ++i) {
    const auto picture = static_cast<int>(random.below(study.classes.size()));
    const auto position = static_cast<std::ptrdiff_t>(1 + random.below(trials.size()));
    Trial trial = rated_trial(picture, trials[static_cast<std::size_t>(position - 1)].place.block);
    trial.role = Role::catch_trial;
    trial.planes.front() = {.field = {}, .blank = true};
    trials.insert(trials.begin() + position, std::move(trial));
  }
}

void number_trials(std::vector<Trial>& trials, int first) {
  for (Trial& trial : trials) trial.place.trial = first++;
}

std::vector<ImageDeck> decks_of(const Study& study) {
  std::vector<ImageDeck> decks;
  for (const StudyClass& one : study.classes) decks.emplace_back(one.images.size());
  return decks;
}

int blocks_of(const Study& study) {
  return study.trials.blocks == Blocks::by_method ? study.presented_methods()
                                                  : study.trials.repeats;
}

Schedule draw_schedule(const Study& study, const ScheduleDraw& draw) {
  RandomStream random(draw.secret, "rating: order", static_cast<std::uint64_t>(draw.visit));
  std::vector<ImageDeck> decks = decks_of(study);
  Schedule schedule;
  for (int block = 0; block < blocks_of(study); ++block) {
    std::ranges::move(draw_block(study, draw, block, random, decks),
                      std::back_inserter(schedule.trials));
  }
  add_catch_trials(study, study.trials.catch_trials, random, schedule.trials);
  number_trials(schedule.trials, 1);
  return schedule;
}

class RatingOrder final : public Order {
 public:
  RatingOrder(const Study& study, const ScheduleDraw& draw)
      : Order(draw_schedule(study, draw), draw.secret), study_(study), draw_(draw) {}

  std::vector<Trial> redraw_block(int block, int restarts_before, int first_trial) const override {
    if (block < 0 || block >= blocks_of(study_) || restarts_before < 0) {
      throw std::invalid_argument("Order: the schedule has no such block or restart");
    }
    RandomStream random(draw_.secret,
                        fmt::format("rating: block {}, restart {}", block, restarts_before + 1),
                        static_cast<std::uint64_t>(draw_.visit));
    std::vector<ImageDeck> decks = decks_of(study_);
    std::vector<Trial> trials = draw_block(study_, draw_, block, random, decks);
    const auto catches = std::ranges::count_if(schedule().trials, [block](const Trial& trial) {
      return trial.place.block == block && trial.role == Role::catch_trial;
    });
    add_catch_trials(study_, static_cast<int>(catches), random, trials);
    number_trials(trials, first_trial);
    return trials;
  }

 private:
  const Study& study_;
  ScheduleDraw draw_;
};

class RatingTask final : public Task {
 public:
  explicit RatingTask(RatingOptions options) : options_(std::move(options)) {}

  [[nodiscard]] const RatingOptions& options() const noexcept { return options_; }

  void check(const JsonValue& file, const Study& study) const override;
  std::string plaintext_settings() const override;
  std::string rule(const Study& study) const override {
    return fmt::format(
        "touchtrial rating 1: every texture once before any is repeated, shuffled by "
        "BLAKE2b(participant's secret, purpose); classes={}; methods={}; repeats={}; blocks={}; "
        "rove_db={}; catch={}",
        study.classes.size(), study.presented_methods(), study.trials.repeats,
        name_of(study.trials.blocks), study.trials.rove_db, study.trials.catch_trials);
  }
  int scored_trials(const Study& study) const override {
    return static_cast<int>(study.classes.size()) * study.presented_methods() *
           study.trials.repeats;
  }
  TrialQuestion ask(const Study& study, const Place& /*place*/) const override {
    return {.question = RatingQuestion{.title = "rate_title", .scales = scales_of(study)}};
  }
  std::unique_ptr<Order> order(const Study& study, const ScheduleDraw& draw) const override {
    return std::make_unique<RatingOrder>(study, draw);
  }
  Practice practice(const Study& study, const ScheduleDraw& draw, int round) const override;

 private:
  RatingOptions options_;
};

void RatingTask::check(const JsonValue& file, const Study& study) const {
  const std::string& language = study.session.language;
  for (std::size_t i = 0; i < options_.scales.size(); ++i) {
    const RatedScale& scale = options_.scales[i];
    const auto require = [&](const char* key, const Translated& words) {
      if (words.contains(language) || (words.empty() && scale.id == kDefaultScale)) return;
      file.refuse_below(fmt::format("/rating/scales/{}/{}/{}", i, key, language),
                        "is missing, but is the study's language; add it");
    };
    require("text", scale.text);
    require("low", scale.low);
    require("high", scale.high);
  }
  const TrialOptions& trials = study.trials;
  const auto refuse = [&](const char* key, const char* what) {
    file.refuse_below(std::string("/trials") + key, what);
  };
  if (trials.order != TrialOrder::shuffled) refuse("/order", "must be \"shuffled\" for ratings");
  if (trials.lead_in > 0) refuse("/lead_in", "must be 0, because ratings have no lead-in");
  if (trials.max_run > 0) {
    refuse("/max_run", "must be 0, because every texture is presented once before any is repeated");
  }
  if (study.visits.methods == VisitMethods::divided) {
    file.refuse_below("/visits/methods",
                      "must be \"all\", because participants rate every method at each visit");
  }
  if (study.session.confidence_levels > 0) {
    file.refuse_below("/session/confidence", "must be 0, because ratings have no confidence");
  }
  if (study.session.sight == Sight::blindfold) {
    file.refuse_below("/session/sight",
                      "must be \"curtain\", because participants compare textures with pictures");
  }
}

std::string RatingTask::plaintext_settings() const {
  RatingOptions copy = options_;
  return written_section([&copy](ObjectIo& io) { describe(io, copy); }, [](ObjectIo& /*io*/) {})
      .dump();
}

Practice RatingTask::practice(const Study& study, const ScheduleDraw& draw, int round) const {
  Practice practice = Task::practice(study, draw, round);
  practice.labels.clear();
  practice.criterion = 0;  // ratings cannot be right or wrong
  for (Trial& trial : practice.trials) {
    trial.right.reset();
    trial.picture = trial.field().class_index;
  }
  if (options_.anchors && !practice.trials.empty()) {
    Trial low = practice.trials.front();
    low.planes.front() = {.field = {}, .blank = true};
    practice.trials.insert(practice.trials.begin(), std::move(low));
    for (std::size_t i = 0; i < practice.trials.size(); ++i) {
      practice.trials[i].place.trial = static_cast<int>(i) + 1;
    }
  }
  return practice;
}

std::shared_ptr<const Task> read_task(const std::optional<JsonValue>& section) {
  RatingOptions options;
  if (section) read_settings(*section, [&](ObjectIo& io) { describe(io, options); });
  return std::make_shared<RatingTask>(std::move(options));
}

}  // namespace

const RatingOptions& options_of(const Study& study) {
  return static_cast<const RatingTask&>(*study.task).options();
}

std::vector<Scale> scales_of(const Study& study) {
  const std::string& language = study.session.language;
  std::vector<Scale> scales;
  for (const RatedScale& scale : options_of(study).scales) {
    const auto text_in_language = [&](const Translated& text, const char* key) {
      if (const auto found = text.find(language); found != text.end()) return found->second;
      return texts_of(study.session).at("screens").at(key);
    };
    scales.push_back({.id = scale.id,
                      .text = text_in_language(scale.text, "scale_fit"),
                      .low = text_in_language(scale.low, "scale_fit_low"),
                      .high = text_in_language(scale.high, "scale_fit_high"),
                      .points = scale.points});
  }
  return scales;
}

const Protocol& protocol() {
  static constexpr Protocol kProtocol{.name = "rating",
                                      .section = "rating",
                                      .read = read_task,
                                      .min_classes = 1,
                                      .section_schema = section_schema};
  return kProtocol;
}

}  // namespace touchtrial::study::rating
