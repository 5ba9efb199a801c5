// What a study file says of ratings, what its participants are presented, and whole sessions of
// them.
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/verification/verification.hpp"
#include "core/errors.hpp"
#include "protocols/rating/study/rating.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulation.hpp"
#include "record/payload_json.hpp"
#include "record/session_recorder.hpp"
#include "record/study_store.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;
using std::chrono::seconds;

constexpr int kClasses = 3;
constexpr int kMethods = 2;
constexpr int kRepeats = 4;
constexpr int kCatch = 5;
constexpr int kScored = kClasses * kMethods * kRepeats;

json rating_file() {
  return json::parse(R"({"study": "s", "protocol": "rating",
    "classes": [{"label": "granite", "images": ["g0.png", "g1.png"]},
                {"label": "linen", "images": ["l0.png", "l1.png"]},
                {"label": "wool", "images": ["w0.png", "w1.png"]}],
    "methods": [{"name": "adaptive"}, {"name": "tv-gabor"}],
    "trials": {"repeats": 4, "catch": 5, "blocks": "mixed"}})");
}

json rough_scale() {
  return json::parse(R"({"id": "rough", "text": {"en": "How rough?"}, "low": {"en": "smooth"},
    "high": {"en": "rough"}, "points": 7})");
}

json practising_file() {
  json file = rating_file();
  file["trials"]["practice"] = 3;
  file["practice"] = json::parse(R"({"classes": [{"label": "sand", "images": ["sand.png"]},
    {"label": "cork", "images": ["cork.png"]}], "criterion": 2, "rounds": 2})");
  return file;
}

study::Study study_of(const json& file) {
  return study::parse_study(file.dump(), ".", "s.json");
}

std::string refusal_of(const json& file) {
  return message_of<StudyError>([&] { return study_of(file); });
}

study::ScheduleDraw draw_of(std::uint64_t seed, int method_order = 0) {
  return {.secret = SeededEntropy(seed).secret("rating_study_test"), .method_order = method_order};
}

std::vector<study::Trial> trials_of(const study::Study& study, const study::ScheduleDraw& draw) {
  return study::make_schedule(study, draw).trials;
}

bool is_scored(const study::Trial& trial) {
  return trial.role == study::Role::scored;
}

std::vector<study::Trial> scored_of(std::vector<study::Trial> trials) {
  std::erase_if(trials, [](const study::Trial& trial) { return !is_scored(trial); });
  return trials;
}

/// How often each class comes by each method.
std::map<std::pair<int, int>, int> counts_of(const std::vector<study::Trial>& trials) {
  std::map<std::pair<int, int>, int> counts;
  for (const study::Trial& trial : trials) {
    ++counts[{trial.field().class_index, trial.field().method}];
  }
  return counts;
}

/// A session of the study in memory, at its first trial, at 3 s.
struct Laboratory {
  explicit Laboratory(const study::Study& study)
      : session(study::make_order(study, draw_of(1)), study.trials,
                record::SessionRecorder(1, SecretKey{}, sink)) {}

  void begin() {
    record::SessionOpening opening;
    opening.participant = "P001";
    opening.enrolment = 1;
    session.open(seconds(1), opening, "{}");
    session.calibrate(seconds(2));
    session.instruct(seconds(3));
  }
  void rate_trial(std::vector<double> values) {
    session.present(now += seconds(1));
    session.contact(now += seconds(1));
    session.end_exploring(now += seconds(1));
    session.rate(std::move(values));
    session.confirm(now += seconds(1));
  }
  /// Rates what is left, and returns its trials in order.
  std::vector<study::Trial> rate_the_rest() {
    std::vector<study::Trial> rest;
    while (session.phase() == session::SessionPhase::ready) {
      rest.push_back(*session.current());
      rate_trial({0.5});
    }
    return rest;
  }

  record::BufferedEvents sink;
  session::Session session;
  seconds now{3};
};

/// A simulated tiny study, closed and unblinded.
class SimulatedRatings {
 public:
  explicit SimulatedRatings(const TinyStudyOptions& options)
      : tiny_(options),
        store_(record::StudyStore::create(
            tiny_.next_database(), session::commitment_of(tiny_.key(), tiny_.pack(), true, false),
            std::chrono::nanoseconds(0), tiny_.key().signer())) {
    simulation::SubjectModel subject;
    subject.feature_noise = 0.2;
    subject.explore_s = 2.0;
    subject.training_passes = 2;
    report_ = simulation::simulate_study(tiny_.key(), tiny_.pack(), subject,
                                         {.participants = 3, .seed = 4}, store_);
    store_.close_study(store_.events(0).back().at);
    store_.unblind(store_.events(0).back().at, "the end", false);
  }

  [[nodiscard]] const TinyStudy& tiny() const { return tiny_; }
  [[nodiscard]] const record::StudyStore& store() const { return store_; }
  [[nodiscard]] const simulation::SimulationReport& report() const { return report_; }

 private:
  TinyStudy tiny_;
  record::StudyStore store_;
  simulation::SimulationReport report_;
};

TinyStudyOptions tiny_ratings() {
  return {.comparison = true,
          .protocol = "rating",
          .section = R"({"scales": [{"id": "fit"}, )" + rough_scale().dump() + "]}",
          .trials = R"({"repeats": 2, "catch": 3, "blocks": "mixed"})"};
}

}  // namespace

TEST_CASE("without its section a rating study asks for the fit alone, in its own language") {
  const study::Study study = study_of(rating_file());
  const study::rating::RatingOptions& options = study::rating::options_of(study);
  REQUIRE(options.scales.size() == 1);
  CHECK(options.scales[0].id == "fit");
  CHECK(options.scales[0].points == 0);
  CHECK(options.anchors);
  json german = rating_file();
  german["session"]["language"] = "de";
  const std::vector<study::Scale> scales = study::rating::scales_of(study_of(german));
  REQUIRE(scales.size() == 1);
  const study::Texts all = study::texts_of(study_of(german).session);
  const auto& texts = all.at("screens");
  CHECK(scales[0].text == texts.at("scale_fit"));
  CHECK(scales[0].low == texts.at("scale_fit_low"));
  CHECK(scales[0].high == texts.at("scale_fit_high"));
  CHECK(scales[0].text != study::rating::scales_of(study).at(0).text);
}

TEST_CASE("scales are those of the section, in the study's language") {
  json file = rating_file();
  json rough = rough_scale();
  rough["text"]["de"] = "Wie rau?";
  rough["low"]["de"] = "glatt";
  rough["high"]["de"] = "rau";
  file["rating"] = {{"scales", {{{"id", "fit"}}, rough}}, {"anchors", false}};
  file["session"]["language"] = "de";
  const study::Study study = study_of(file);
  CHECK_FALSE(study::rating::options_of(study).anchors);
  const std::vector<study::Scale> scales = study::rating::scales_of(study);
  REQUIRE(scales.size() == 2);
  CHECK(scales[1] == study::Scale{"rough", "Wie rau?", "glatt", "rau", 7});
  CHECK(scales[1].min() == 1.0);
  CHECK(scales[1].max() == 7.0);
  CHECK(study::trial_question_of(study).scales() == scales);
}

TEST_CASE("what of the section is impossible is refused with its place") {
  const auto refused = [](const json& section, const std::string& places) {
    json file = rating_file();
    file["rating"] = section;
    INFO(section.dump());
    CHECK_THAT(refusal_of(file), names("s.json " + places));
  };
  const auto refused_scale = [&](const std::string& key, const json& value,
                                 const std::string& places) {
    json scale = rough_scale();
    scale[key] = value;
    refused({{"scales", json::array({{{"id", "fit"}}, scale})}}, "/rating/scales/1" + places);
  };
  json seven = json::array();
  for (int i = 0; i < 7; ++i) {
    seven.push_back(rough_scale());
    seven.back()["id"] = "scale" + std::to_string(i);
  }
  refused(json::array(), "/rating");
  refused({{"scale", 1}}, "/rating/scale");
  refused({{"anchors", "yes"}}, "/rating/anchors");
  refused({{"scales", "fit"}}, "/rating/scales");
  refused({{"scales", json::array()}}, "/rating/scales 0 1 6");
  refused({{"scales", seven}}, "/rating/scales 7 1 6");
  seven.erase(6);
  json six = rating_file();
  six["rating"] = {{"scales", seven}};
  CHECK(refusal_of(six).empty());
  refused({{"scales", json::array({rough_scale(), rough_scale()})}}, "/rating/scales/1/id rough");
  refused({{"scales", json::array({json::object()})}}, "/rating/scales/0/id");
  refused_scale("id", "so rough", "/id so rough");
  refused_scale("point", 7, "/point");
  refused_scale("points", 1, "/points 0 2");
  refused_scale("points", 12, "/points 12 0 11");
  refused_scale("points", -1, "/points -1 0 11");
  refused_scale("points", 2.5, "/points");
  for (const char* key : {"text", "low", "high"}) {
    const std::string place = std::string("/") + key;
    refused_scale(key, {{"de", "nichts"}}, place + "/en");
    refused_scale(key, json::object(), place + "/en");
    refused_scale(key, {{"xx", "nichts"}}, place + "/xx");
    json scale = rough_scale();
    scale.erase(key);
    refused({{"scales", json::array({scale})}}, "/rating/scales/0" + place + " ");
    refused({{"scales", json::array({{{"id", "fit"}, {key, {{"de", "nichts"}}}}})}},
            "/rating/scales/0" + place + "/en");
  }
}

TEST_CASE("what of other sections does not suit ratings is refused with its place") {
  const auto refused = [](const std::string& pointer, const json& value,
                          const std::string& places) {
    json file = rating_file();
    file[json::json_pointer(pointer)] = value;
    INFO(pointer << " = " << value.dump());
    CHECK_THAT(refusal_of(file), names("s.json " + places));
  };
  for (const char* order : {"de-bruijn", "uniform", "williams"}) {
    refused("/trials/order", order, "/trials/order shuffled");
  }
  refused("/trials/lead_in", 1, "/trials/lead_in 0");
  refused("/trials/max_run", 1, "/trials/max_run 0");
  json divided = rating_file();
  divided["trials"]["blocks"] = "by-method";
  divided["visits"] = {{"count", 2}, {"methods", "divided"}};
  CHECK_THAT(refusal_of(divided), names("s.json /visits/methods all"));
  divided["visits"]["methods"] = "all";
  CHECK(refusal_of(divided).empty());
  refused("/registration/estimand", "difference", "/registration/estimand difference");
  refused("/session/confidence", 5, "/session/confidence 0");
  refused("/session/sight", "blindfold", "/session/sight curtain");
  json other = rating_file();
  other["rating"] = json::object();
  CHECK(refusal_of(other).empty());
  other["protocol"] = "classification";
  CHECK_THAT(refusal_of(other), names("s.json /rating"));
}

TEST_CASE("one texture by one method can be rated") {
  json file = rating_file();
  file["classes"].erase(2);
  file["classes"].erase(1);
  file["methods"].erase(1);
  CHECK(refusal_of(file).empty());
}

TEST_CASE("every texture comes by every method once in each block, under its own picture") {
  const study::Study study = study_of(rating_file());
  CHECK(study.scored_trials() == kScored);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const study::Schedule schedule = study::make_schedule(study, draw_of(seed));
    REQUIRE(schedule.trials.size() == kScored + kCatch);
    std::map<int, std::vector<study::Trial>> blocks;
    std::map<std::pair<int, int>, int> images;
    int before = 0;
    for (std::size_t i = 0; i < schedule.trials.size(); ++i) {
      const study::Trial& trial = schedule.trials[i];
      CHECK(trial.place.trial == static_cast<int>(i) + 1);
      CHECK(trial.place.block >= before);
      before = trial.place.block;
      CHECK_FALSE(trial.right.has_value());
      REQUIRE(trial.planes.size() == 1);
      if (!is_scored(trial)) continue;
      CHECK_FALSE(trial.planes[0].blank);
      CHECK(trial.planes[0].gain_db == 0.0);
      CHECK(trial.picture == trial.field().class_index);
      CHECK(study::picture_of(study, trial) ==
            study.classes[static_cast<std::size_t>(trial.field().class_index)].label);
      blocks[trial.place.block].push_back(trial);
      ++images[{trial.field().class_index, trial.field().exemplar}];
    }
    CHECK(blocks.size() == kRepeats);
    for (const auto& [block, trials] : blocks) {
      const auto counts = counts_of(trials);
      CHECK(counts.size() == kClasses * kMethods);
      for (const auto& [item, count] : counts) CHECK(count == 1);
    }
    // All images of a class are dealt before any comes again.
    CHECK(images.size() == kClasses * 2);
    for (const auto& [image, count] : images) CHECK(count == kMethods * kRepeats / 2);
  }
}

TEST_CASE("catch trials are planes without texture, each with a picture, and never the first") {
  const study::Study study = study_of(rating_file());
  std::set<int> pictures;
  std::set<int> places;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::vector<study::Trial> trials = trials_of(study, draw_of(seed));
    CHECK(is_scored(trials.front()));
    int caught = 0;
    for (const study::Trial& trial : trials) {
      if (is_scored(trial)) continue;
      ++caught;
      CHECK(trial.role == study::Role::catch_trial);
      REQUIRE(trial.planes.size() == 1);
      CHECK(trial.planes[0].blank);
      REQUIRE(trial.picture.has_value());
      pictures.insert(*trial.picture);
      places.insert(trial.place.trial);
      // Nothing about the plane depends on the picture.
      CHECK(trial.planes[0].field == study::StimulusIndex{});
    }
    CHECK(caught == kCatch);
  }
  CHECK(pictures == std::set<int>{0, 1, 2});
  CHECK(places.size() > kScored / 2);
}

TEST_CASE("by method each method has a block, in which textures come once before any repeats") {
  json file = rating_file();
  file["trials"]["blocks"] = "by-method";
  const study::Study study = study_of(file);
  std::set<int> first_methods;
  for (int row = 0; row < 2; ++row) {
    const std::vector<study::Trial> all = trials_of(study, draw_of(3, row));
    CHECK(all.size() == kScored + kCatch);
    const std::vector<study::Trial> trials = scored_of(all);
    first_methods.insert(trials.front().field().method);
    for (const auto& [item, count] : counts_of(trials)) CHECK(count == kRepeats);
    for (int pass = 0; pass < kMethods * kRepeats; ++pass) {
      std::set<int> felt;
      for (int i = 0; i < kClasses; ++i) {
        const study::Trial& trial = trials[static_cast<std::size_t>(pass * kClasses + i)];
        felt.insert(trial.field().class_index);
        CHECK(trial.place.block == pass / kRepeats);
        CHECK(trial.field().method ==
              trials[trial.place.block == 0 ? 0 : kScored / 2].field().method);
      }
      CHECK(felt.size() == kClasses);
    }
    CHECK(trials.front().field().method != trials.back().field().method);
  }
  CHECK(first_methods.size() == 2);
}

TEST_CASE("gains are roved below the pack's, each trial by itself") {
  json file = rating_file();
  file["trials"]["rove_db"] = 6.0;
  std::set<double> gains;
  for (const study::Trial& trial : scored_of(trials_of(study_of(file), draw_of(2)))) {
    CHECK(trial.planes[0].gain_db <= 0.0);
    CHECK(trial.planes[0].gain_db >= -6.0);
    gains.insert(trial.planes[0].gain_db);
  }
  CHECK(gains.size() == kScored);
}

TEST_CASE("a participant's trials are a function of the draw; other participants have others") {
  const study::Study study = study_of(rating_file());
  CHECK(study::make_schedule(study, draw_of(1)) == study::make_schedule(study, draw_of(1)));
  std::set<std::string> orders;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::string order;
    for (const study::Trial& trial : trials_of(study, draw_of(seed))) {
      order += std::to_string(10 * trial.field().class_index + trial.field().method) + ",";
    }
    orders.insert(order);
  }
  CHECK(orders.size() == 20);
  study::ScheduleDraw second = draw_of(1);
  second.visit = 2;
  CHECK(trials_of(study, second) != trials_of(study, draw_of(1)));
}

TEST_CASE("nothing in clear, on the screen or in the number of trials tells a stimulus") {
  json file = rating_file();
  file["rating"] = {{"scales", {{{"id", "fit"}}, rough_scale()}}};
  const study::Study study = study_of(file);
  const json plaintext_settings = json::parse(study.task->plaintext_settings());
  CHECK(plaintext_settings.size() == 2);
  CHECK(plaintext_settings.at("anchors") == true);
  REQUIRE(plaintext_settings.at("scales").size() == 2);
  CHECK(plaintext_settings.at("scales").at(1) == rough_scale());
  const std::string clear = study.task->plaintext_settings() + study.task->rule(study);
  for (const char* word : {"granite", "linen", "wool", ".png", "adaptive", "tv-gabor"}) {
    CHECK(clear.find(word) == std::string::npos);
  }
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const study::Schedule schedule = study::make_schedule(study, draw_of(seed));
    CHECK(schedule.layout.empty());
    CHECK(schedule.trials.size() == kScored + kCatch);
    for (const study::Trial& trial : schedule.trials) {
      const study::TrialQuestion ask = study.task->ask(study, trial.place);
      CHECK(ask.planes == 1);
      CHECK(ask.choices().empty());
      CHECK(ask.scales() == study::rating::scales_of(study));
      CHECK(ask.title() == "rate_title");
      CHECK(ask.confidence_levels == 0);
      CHECK_FALSE(ask.feedback);
    }
  }
}

TEST_CASE("an answer is one rating on each scale, between its ends") {
  json file = rating_file();
  file["rating"] = {{"scales", {{{"id", "fit"}}, rough_scale()}}};
  const study::TrialQuestion ask = study::trial_question_of(study_of(file));
  CHECK(study::mismatch_of(RatingAnswer{{0.0, 1.0}}, ask).empty());
  CHECK(study::mismatch_of(RatingAnswer{{1.0, 7.0}}, ask).empty());
  CHECK_THAT(study::mismatch_of(RatingAnswer{{0.5}}, ask), names("1 2"));
  CHECK_THAT(study::mismatch_of(RatingAnswer{{1.1, 7.0}}, ask), names("fit"));
  CHECK_THAT(study::mismatch_of(RatingAnswer{{0.5, 0.0}}, ask), names("rough"));
  CHECK_THAT(study::mismatch_of(ChoiceAnswer{0}, ask), names("0 0"));
}

TEST_CASE("practice begins with the scale's ends, and no answer of it is right") {
  const study::Study study = study_of(practising_file());
  const study::Practice practice = study::practice_of(study, draw_of(1));
  CHECK(practice.labels.empty());
  CHECK(practice.criterion == 0);
  CHECK(practice.rounds == 2);
  REQUIRE(practice.trials.size() == 4);
  for (std::size_t i = 0; i < practice.trials.size(); ++i) {
    const study::Trial& trial = practice.trials[i];
    CHECK(trial.place.trial == static_cast<int>(i) + 1);
    CHECK(trial.role == study::Role::practice);
    CHECK_FALSE(trial.right.has_value());
    CHECK(trial.planes.at(0).blank == (i == 0));
    const std::string picture = study::picture_of(study, trial);
    CHECK((picture == "sand" || picture == "cork"));
    if (i > 0) CHECK(trial.picture == trial.field().class_index);
  }
  CHECK(practice.trials[0].picture == practice.trials[1].picture);
  CHECK(study::practice_of(study, draw_of(1)).trials == practice.trials);

  json plain = practising_file();
  plain["rating"] = {{"anchors", false}};
  const study::Practice without = study::practice_of(study_of(plain), draw_of(1));
  REQUIRE(without.trials.size() == 3);
  CHECK_FALSE(without.trials[0].planes.at(0).blank);
  CHECK(study::practice_of(study_of(rating_file()), draw_of(1)).trials.empty());
}

TEST_CASE("a simulated rating study passes every check, and catch trials are rated low") {
  const SimulatedRatings study(tiny_ratings());
  CHECK(study.report().sessions == 3);
  CHECK(study.report().presentations == 3 * (5 * 2 * 2 + 3));
  const analysis::Verification verification =
      analysis::verify_study(study.store(), &study.tiny().key(), &study.tiny().pack());
  for (const analysis::Check& check : verification.checks) {
    INFO(check.name << ": " << check.detail);
    CHECK(check.state == analysis::CheckState::passed);
  }
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.tiny().key());
  const study::TrialQuestion ask = study::trial_question_of(outcomes.design);
  double scored_sum = 0.0;
  double catch_sum = 0.0;
  int scored = 0;
  int caught = 0;
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    REQUIRE(trial.row.answer.has_value());
    CHECK(study::mismatch_of(*trial.row.answer, ask).empty());
    CHECK_FALSE(trial.response.has_value());
    REQUIRE(trial.picture.has_value());
    const double fit = ratings_of(trial.row.answer).at(0);
    if (trial.role == study::Role::catch_trial) {
      CHECK_FALSE(trial.counted);
      catch_sum += fit;
      ++caught;
    } else {
      CHECK(trial.counted);
      CHECK(trial.picture == trial.stimulus.class_index);
      scored_sum += fit;
      ++scored;
    }
  }
  CHECK(scored == 3 * 5 * 2 * 2);
  REQUIRE(caught == 3 * 3);
  CHECK(catch_sum / caught < scored_sum / scored);
}

TEST_CASE("nothing in clear of a stored session tells a rating or what was felt") {
  const SimulatedRatings study(tiny_ratings());
  for (const record::Event& event : study.store().events(1)) {
    for (const char* word : {"\"ratings\"", "\"picture\"", "\"position\"", "\"bark\""}) {
      INFO(event.body);
      CHECK(event.body.find(word) == std::string::npos);
    }
  }
}

TEST_CASE("ratings are stored as they were given, and take the place of those before") {
  const study::Study study = study_of(rating_file());
  Laboratory lab(study);
  lab.begin();
  lab.session.present(lab.now += seconds(1));
  lab.session.end_exploring(lab.now += seconds(1));
  CHECK_THROWS_AS(lab.session.choose(0), std::invalid_argument);
  CHECK_THROWS_AS(lab.session.rate({std::numeric_limits<double>::quiet_NaN()}),
                  std::invalid_argument);
  CHECK(lab.session.phase() == session::SessionPhase::answering);
  for (const double value : {0.25, 0.5, 0.125}) lab.session.rate({value});
  lab.session.confirm(lab.now += seconds(1));
  CHECK(lab.session.presentations_left() == kScored + kCatch - 1);
  const record::AnswerBody body =
      record::from_json<record::AnswerBody>(as_recorded(lab.sink.events.back(), SecretKey{}).body);
  CHECK(body.trial == 1);
  CHECK(body.answer == Answer{RatingAnswer{{0.125}}});
  CHECK_FALSE(body.confidence.has_value());
}

TEST_CASE("a session of ratings is restored from its events, and goes on as if nothing had been") {
  const study::Study study = study_of(rating_file());
  Laboratory lab(study);
  lab.begin();
  for (const double value : {0.0, 0.333, 1.0}) lab.rate_trial({value});
  lab.session.present(lab.now += seconds(1));
  lab.session.interrupt(lab.now += seconds(1), "comfort stop");
  lab.rate_trial({0.75});

  Laboratory again(study);
  again.session.restore(as_recorded(lab.sink.events, SecretKey{}));
  again.now = lab.now;
  CHECK(again.sink.events.empty());
  CHECK(again.session.phase() == lab.session.phase());
  CHECK(again.session.last() == lab.session.last());
  CHECK(again.session.presentations_begun() == 5);
  CHECK(again.session.presentations_left() == lab.session.presentations_left());
  const std::vector<study::Trial> rest = lab.rate_the_rest();
  CHECK(again.rate_the_rest() == rest);
  CHECK(rest.size() == kScored + kCatch - 4);
  CHECK(rest.back().place.trial == 4);
  CHECK(again.session.phase() == session::SessionPhase::finished);
  CHECK(again.sink.events.back().sequence == lab.sink.events.back().sequence);
}

TEST_CASE("a session that ended during a rating is taken up with that trial at the end") {
  const study::Study study = study_of(rating_file());
  Laboratory lab(study);
  lab.begin();
  lab.rate_trial({0.2});
  lab.session.present(lab.now += seconds(1));
  lab.session.end_exploring(lab.now += seconds(1));
  lab.session.rate({0.9});  // not confirmed, and so not given

  Laboratory again(study);
  again.session.restore(as_recorded(lab.sink.events, SecretKey{}));
  again.session.resume_after_exit(again.now = lab.now + seconds(60),
                                  {.after = "program-ended", .away_s = 60.0});
  CHECK(again.session.current()->place.trial == 3);
  const std::vector<study::Trial> rest = again.rate_the_rest();
  CHECK(rest.size() == kScored + kCatch - 1);
  CHECK(rest.back().place.trial == 2);
}

TEST_CASE("a block that is restarted is the same for the same draw, and has the same textures") {
  const study::Study study = study_of(rating_file());
  const auto order = study::make_order(study, draw_of(1));
  CHECK_FALSE(order->is_adaptive());
  std::vector<study::Trial> block = order->schedule().trials;
  std::erase_if(block, [](const study::Trial& trial) { return trial.place.block != 1; });
  const std::vector<study::Trial> restarted = order->redraw_block(1, 0, 100);
  CHECK(study::make_order(study, draw_of(1))->redraw_block(1, 0, 100) == restarted);
  CHECK(order->redraw_block(1, 1, 100) != restarted);
  REQUIRE(restarted.size() == block.size());
  for (std::size_t i = 0; i < restarted.size(); ++i) {
    CHECK(restarted[i].place.trial == 100 + static_cast<int>(i));
    CHECK(restarted[i].place.block == 1);
  }
  CHECK(counts_of(scored_of(restarted)) == counts_of(scored_of(block)));
}

}  // namespace touchtrial
