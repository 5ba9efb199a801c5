#include "protocols/procedures/procedure.hpp"
#include "protocols/procedures/simulated_tracks.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::procedures;
using namespace touchtrial::tracked;

namespace {

Digest some_secret(std::uint8_t first) {
  Digest secret{};
  secret[0] = first;
  return secret;
}

BlockSettings every_kind() {
  BlockSettings block;
  for (const ProcedureKind& kind : procedure_kinds()) {
    block.tracks.push_back(usual_track(std::string(kind.name), 24));
  }
  block.catch_trials = 10;
  return block;
}

/// The mean proportion correct of the last nine tenths of a long staircase.
double share_of_long_track(UpDown rule, const std::string& name) {
  TrackSettings settings = usual_track(name, 40'000);
  rule.first_level = 20;
  rule.steps_down = {1};
  settings.up_down = rule;
  settings.levels.clear();
  for (int i = 0; i <= 80; ++i) settings.levels.push_back(-40.0 + 0.5 * i);
  const Observer observer{Shape::logistic, -20.0, 0.25, 0.0, 0.0};
  double sum = 0.0;
  double n = 0.0;
  const std::vector<TrackTrial> trials = answered_track(settings, observer, 3);
  for (std::size_t i = trials.size() / 10; i < trials.size(); ++i) {
    sum += settings.levels[trials[i].level];
    n += 1.0;
  }
  return shares_at(observer, sum / n).correct;
}

Posterior belief_after(const TrackSettings& track, std::span<const TrackTrial> trials) {
  Posterior posterior(track.levels, track.grid);
  for (const TrackTrial& trial : trials) posterior.observe(trial.level, trial.correct);
  return posterior;
}

}  // namespace

TEST_CASE("staircases converge to the points of Levitt and Kaernbach") {
  // Levitt 1971, table 1; Kaernbach 1991: 75 % with a step up of three steps down.
  CHECK(convergence_of({1, 1, {1}, 1}) == Approx(0.5));
  CHECK(convergence_of({2, 1, {1}, 1}) == Approx(0.707).margin(5e-4));
  CHECK(convergence_of({3, 1, {1}, 1}) == Approx(0.794).margin(5e-4));
  CHECK(convergence_of({4, 1, {1}, 1}) == Approx(0.841).margin(5e-4));
  CHECK(convergence_of({1, 2, {1}, 1}) == Approx(0.293).margin(5e-4));
  CHECK(convergence_of({1, 1, {1}, 3}) == Approx(0.75));
  CHECK_THROWS_AS(convergence_of({2, 2, {1}, 1}), std::invalid_argument);
  // Where long tracks in fact stay; small steps on a shallow function.
  CHECK(share_of_long_track({2, 1, {1}, 1}, "up-down") == Approx(0.707).margin(0.015));
  CHECK(share_of_long_track({3, 1, {1}, 1}, "up-down") == Approx(0.794).margin(0.015));
  CHECK(share_of_long_track({1, 1, {1}, 3}, "weighted-up-down") == Approx(0.75).margin(0.015));
}

TEST_CASE("a staircase counts answers in a row and shortens its steps at reversals") {
  TrackSettings settings = usual_track("up-down", 12);
  RandomStream unused(1, "test");
  const std::unique_ptr<Procedure> procedure = make_procedure(settings, unused);
  std::vector<std::size_t> levels;
  for (const bool correct : {true, true, true, true, false, true, false, true, true, false}) {
    levels.push_back(procedure->next());
    procedure->answer(correct);
  }
  levels.push_back(procedure->next());
  // Down 4, down 4; turn: up 2, and again 2; turn: down 1; turn: up 1.
  CHECK(levels == std::vector<std::size_t>{30, 30, 26, 26, 22, 24, 24, 26, 26, 25, 26});
}

TEST_CASE("a staircase stays within its levels") {
  TrackSettings settings = usual_track("up-down", 60);
  const Observer always{Shape::weibull, -400.0, 3.0, 0.5, 0.0};
  const std::vector<TrackTrial> trials = answered_track(settings, always, 1);
  CHECK(trials.back().level == 0);
  const Observer never{Shape::weibull, 400.0, 3.0, 0.0, 0.0};
  CHECK(answered_track(settings, never, 1).back().level == 40);
}

TEST_CASE("constant stimuli present every level equally often, mixed or in blocks") {
  for (const bool blocked : {false, true}) {
    TrackSettings settings = usual_track("constant-stimuli", 60);
    settings.blocked = blocked;
    const std::vector<TrackTrial> trials = answered_track(settings, some_observer(1), 5);
    std::vector<int> counts(6, 0);
    int changes = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      ++counts[trials[i].level];
      if (i > 0 && trials[i].level != trials[i - 1].level) ++changes;
    }
    CHECK(counts == std::vector<int>(6, 10));
    CHECK((blocked ? changes == 5 : changes > 40));
  }
  TrackSettings uneven = usual_track("constant-stimuli", 61);
  RandomStream random(1, "test");
  CHECK_THROWS_AS(make_procedure(uneven, random), std::invalid_argument);
}

TEST_CASE("a block deals every track once a round and a catch trial in every stretch") {
  Block block(every_kind(), some_secret(1));
  std::vector<int> seen(7, 0);
  std::vector<int> caught(7, 0);
  std::vector<std::size_t> catches;
  std::size_t trial = 0;
  while (const auto now = block.next()) {
    if (!now->is_catch) {
      ++seen[now->track];
      CHECK(*std::max_element(seen.begin(), seen.end()) -
                *std::min_element(seen.begin(), seen.end()) <=
            1);
    } else {
      ++caught[now->track];
      CHECK(now->level == block.settings().tracks[now->track].levels.size() - 1);
      catches.push_back(trial);
    }
    block.answer(trial % 3 != 0);
    ++trial;
  }
  CHECK(seen == std::vector<int>(7, 24));
  REQUIRE(catches.size() == 10);
  std::ranges::sort(caught);
  CHECK(caught == std::vector<int>{1, 1, 1, 1, 2, 2, 2});
  CHECK(catches.front() > 0);
  for (std::size_t i = 0; i < catches.size(); ++i) {
    CHECK(catches[i] / 18 <= i + 1);
    CHECK(catches[i] + 18 >= i * 17);
  }
  block.answer(true);  // after the end: without effect
  CHECK_FALSE(block.next());
}

TEST_CASE("after each answer a replayed block names the same level, and has the same bits") {
  const BlockSettings settings = every_kind();
  Block straight(settings, some_secret(9));
  RandomStream random(4, "test");
  std::vector<bool> answers;
  while (const auto now = straight.next()) {
    if (answers.size() % 29 == 0) {
      Block resumed = replay(settings, some_secret(9), answers);
      REQUIRE(resumed.next());
      CHECK(resumed.next()->track == now->track);
      CHECK(resumed.next()->level == now->level);
    }
    answers.push_back(random.uniform() < 0.8);
    straight.answer(answers.back());
  }
  const Block again = replay(settings, some_secret(9), answers);
  for (std::size_t track = 0; track < settings.tracks.size(); ++track) {
    const TrackSettings& one = settings.tracks[track];
    const Posterior a = belief_after(one, straight.trials(track));
    const Posterior b = belief_after(one, again.trials(track));
    for (std::size_t i = 0; i < a.weights().size(); ++i) {
      CHECK(std::bit_cast<std::uint64_t>(a.weights()[i]) ==
            std::bit_cast<std::uint64_t>(b.weights()[i]));
    }
  }
  answers.push_back(true);
  CHECK_THROWS_AS(replay(settings, some_secret(9), answers), std::invalid_argument);
}

TEST_CASE("a record is checked by choosing again, and the first wrong level is named") {
  const BlockSettings settings = every_kind();
  Block block(settings, some_secret(5));
  RandomStream random(4, "test");
  std::vector<RecordedTrial> record;
  while (const auto now = block.next()) {
    record.push_back({*now, random.uniform() < 0.8});
    block.answer(record.back().correct);
  }
  CHECK_FALSE(first_mismatch(settings, some_secret(5), record));
  std::vector<RecordedTrial> altered = record;
  altered[77].presentation.level += 1;
  CHECK(first_mismatch(settings, some_secret(5), altered).value() == 77);
  altered = record;
  altered[50].correct = !altered[50].correct;  // later levels of its track do not follow
  CHECK(first_mismatch(settings, some_secret(5), altered).value_or(0) > 50);
  record.push_back(record.back());
  CHECK(first_mismatch(settings, some_secret(5), record).value() == record.size() - 1);
}

TEST_CASE("another secret deals another order") {
  const BlockSettings settings = every_kind();
  Block one(settings, some_secret(1));
  Block other(settings, some_secret(2));
  int different = 0;
  for (int i = 0; i < 60; ++i) {
    if (one.next()->track != other.next()->track) ++different;
    one.answer(true);
    other.answer(true);
  }
  CHECK(different > 20);
}

TEST_CASE("impossible tracks are refused") {
  RandomStream random(1, "test");
  const auto refused = [&](const std::string& procedure, void (*change)(TrackSettings&)) {
    TrackSettings bad = usual_track(procedure, 10);
    change(bad);
    CHECK_THROWS_AS(make_procedure(bad, random), std::invalid_argument);
  };
  refused("quest", [](TrackSettings&) {});
  refused("up-down", [](TrackSettings& bad) { bad.levels = {3.0, 2.0}; });
  refused("up-down", [](TrackSettings& bad) { bad.up_down.first_level = 41; });
  refused("up-down", [](TrackSettings& bad) { bad.up_down.steps_down = {0}; });
  refused("weighted-up-down", [](TrackSettings& bad) { bad.up_down.correct_for_down = 2; });
  CHECK_THROWS_AS(Block({}, some_secret(1)), std::invalid_argument);
  BlockSettings many;
  many.tracks.assign(9, usual_track("up-down", 10));
  CHECK_THROWS_AS(Block(many, some_secret(1)), std::invalid_argument);
  many.tracks.resize(1);
  many.catch_trials = 6;
  CHECK_THROWS_AS(Block(many, some_secret(1)), std::invalid_argument);
}
