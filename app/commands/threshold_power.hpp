/// \file What `power` does for a study of thresholds. Private to app.
#pragma once

#include "analysis/planning/power_runs.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::app {

/// Options of `power` that only studies of thresholds have, as they are typed.
struct ThresholdPowerArguments {
  std::string trials;      ///< empty: the study's
  std::string difference;  ///< empty: the first two standards, if there are two
  std::optional<double> width_db{};
  int pool = 100;
};

/// Simulates the participants and prints the report.
/// \param file  of the study
/// \param plan  settled: sizes, runs and seed are used
/// \return the exit code
/// \throws UsageError if an option is impossible for the study
int plan_thresholds(const study::Study& study, const std::filesystem::path& file,
                    const simulation::SubjectModel& subject, const planning::PowerPlan& plan,
                    const ThresholdPowerArguments& arguments, int jobs, bool json);

/// Whole numbers as they are typed: "8,12,16".
/// \param option  for the message
/// \param what  they are, for the message: "a number of participants"
/// \throws UsageError if a part is not a whole number from 0 on
[[nodiscard]] std::vector<int> numbers_named(std::string_view text, const std::string& option,
                                             const std::string& what);

}  // namespace touchtrial::app
