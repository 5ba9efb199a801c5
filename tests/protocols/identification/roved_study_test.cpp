// A simulated study with roved gains, from its schedule to its table.
#include "analysis/exports/trial_tables.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulation.hpp"
#include "study/order_test_support.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace touchtrial {

TEST_CASE("the gains of a whole study stand in its table once it is unblinded, as scheduled") {
  TinyStudy study({.trials = R"({"repeats": 8, "rove_db": 6})"});
  simulation::SubjectModel subject{.explore_s = 0.5};
  record::StudyStore store = record::StudyStore::create(
      study.next_database(), session::commitment_of(study.key(), study.pack(), true, false), {},
      study.key().signer());
  static_cast<void>(simulation::simulate_study(study.key(), study.pack(), subject,
                                               {.participants = 5, .seed = 3}, store));
  const auto is_gain = [](const std::string& column) { return column == "gain_db"; };
  CHECK(std::ranges::none_of(analysis::trials_table(store, std::nullopt).columns, is_gain));
  store.close_study({});
  store.unblind({}, "planned", false);
  const analysis::Outcomes outcomes = analysis::load_outcomes(store, study.key());
  const analysis::DataTable table = analysis::trials_table(store, outcomes);
  const auto place = std::ranges::find_if(table.columns, is_gain) - table.columns.begin();
  std::vector<double> gains_db;
  std::map<std::pair<int, bool>, int> by_class_and_half;
  REQUIRE(table.rows.size() == 200);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double gain_db = std::get<double>(table.rows[row].at(static_cast<std::size_t>(place)));
    const study::Schedule schedule = study::make_schedule(
        study.key().study,
        study.key().draw_of(static_cast<int>(row) / 40 + 1, study::Draws::rehearsal));
    const study::Trial& shown = schedule.trials.at(row % 40);
    CHECK(gain_db == shown.planes.front().gain_db);
    CHECK(gain_db >= -6.0);
    CHECK(gain_db <= 0.0);
    gains_db.push_back(gain_db);
    ++by_class_and_half[{shown.field().class_index, gain_db < -3.0}];
  }
  std::ranges::sort(gains_db);
  double farthest = 0.0;  // Kolmogorov and Smirnov's statistic
  for (std::size_t i = 0; i < gains_db.size(); ++i) {
    const double share = static_cast<double>(i) / 200.0;
    const double expected = (gains_db[i] + 6.0) / 6.0;
    farthest = std::max({farthest, std::abs(expected - share), std::abs(expected - share - 0.005)});
  }
  CHECK(farthest * std::sqrt(200.0) < 1.95);                // 99.9 %
  CHECK(chi_square_uniform(by_class_and_half, 10) < 27.9);  // 99.9 %, 9 degrees of freedom
}

}  // namespace touchtrial
