#include "app/run/enrolment_of.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/enrolment_plan.hpp"

#include <filesystem>
#include <set>

namespace touchtrial::app {
namespace {

/// Numbers that are kept for somebody are among them: their first session still stands there.
std::set<int> taken_numbers(const store::StudyStore& store) {
  std::set<int> taken;
  for (const store::SessionRow& row : store.sessions()) taken.insert(row.enrolment);
  return taken;
}

/// Two stations that both take what is free would take the same.
void require_station(const RunOptions& options, const std::filesystem::path& plan) {
  if (!options.station.empty() && !is_there(plan)) {
    throw UsageError(plan.string() +
                     ": is not there, and --station takes numbers from it; copy it here, or make "
                     "it with `touchtrial plan`");
  }
  if (!options.station.empty() || options.pilot || !is_there(plan)) return;
  throw UsageError(plan.string() +
                   ": hands out enrolment numbers to stations; say with --station which this is");
}

/// A file with another station's numbers is that station's, or somebody gave the wrong name.
void require_own_file(const RunOptions& options, const design::EnrolmentPlan& plan,
                      const std::set<int>& taken) {
  for (const int number : taken) {
    const std::string* const owner = design::station_of(plan, number);
    if (owner == nullptr || *owner == options.station) continue;
    throw UsageError(one_line(options.database.string()) + ": has number " +
                     std::to_string(number) + ", which is station " + *owner +
                     "'s; every station has a file of its own: give another --db, or the station's "
                     "right name");
  }
}

}  // namespace

int enrolment_of(const RunOptions& options, const design::Study& study,
                 const store::StudyStore& store) {
  if (options.enrolment > 0) return options.enrolment;
  const int free_or_inherited = store.enrolment_for(options.participant);
  const std::set<int> taken = taken_numbers(store);
  if (taken.contains(free_or_inherited)) return free_or_inherited;
  const std::filesystem::path plan =
      options.plan.empty() ? design::plan_path_for(options.study) : options.plan;
  require_station(options, plan);
  if (options.station.empty()) return free_or_inherited;
  const design::EnrolmentPlan dealt = design::load_plan(plan, study);
  const int next = design::next_of_station(dealt, options.station, taken, plan.string());
  require_own_file(options, dealt, taken);
  return next;
}

}  // namespace touchtrial::app
