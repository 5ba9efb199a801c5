/// \file The plan that assigns enrolment numbers to stations before participants arrive, so that
/// several stations keep orders balanced without contact with each other.
/// Format: docs/several-stations.md, "Handing out enrolment numbers".
#pragma once

#include "protocols/design/study.hpp"

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::design {

/// Consecutive numbers, both ends included.
struct EnrolmentRange {
  int first = 1;
  int last = 1;  ///< >= first

  [[nodiscard]] int size() const noexcept { return last - first + 1; }
  friend bool operator==(const EnrolmentRange&, const EnrolmentRange&) = default;
};

/// One station's numbers.
struct StationShare {
  std::string station;  ///< unique name, of the characters that participant ids allow
  std::vector<EnrolmentRange> ranges;

  [[nodiscard]] int size() const noexcept;
  friend bool operator==(const StationShare&, const StationShare&) = default;
};

/// Every number from 1 to the last one handed out belongs to exactly one station.
struct EnrolmentPlan {
  std::string study;  ///< the study's name
  std::vector<StationShare> stations;

  /// How many numbers have been handed out so far; these are 1 to this.
  [[nodiscard]] int participants() const noexcept;
  friend bool operator==(const EnrolmentPlan&, const EnrolmentPlan&) = default;
};

inline constexpr int kMostPlanned = 1'000'000;
inline constexpr std::size_t kMostStations = 1000;

/// Hands out numbers until the plan has `participants` of them. The stations' totals differ by at
/// most one, as far as the numbers they already have allow. A station gets consecutive numbers as
/// long as these keep its orders of methods as even as possible. Numbers that `plan` already
/// assigns stay where they are.
/// \param participants  new total, from plan.participants() to kMostPlanned
/// \throws std::invalid_argument if the plan has no stations or `participants` is out of range
void extend_plan(EnrolmentPlan& plan, const Study& study, int participants);

/// A plan without numbers.
/// \param stations  1 to kMostStations names
/// \throws UsageError if there are too few or too many names, a name is not 1 to 32 of
///   [0-9A-Za-z+-_], or a name occurs twice
[[nodiscard]] EnrolmentPlan empty_plan(const Study& study, std::span<const std::string> stations);

/// How often each order of method blocks occurs among some enrolment numbers: one count for each
/// row of the Williams design.
[[nodiscard]] std::vector<int> orders_of(const Study& study,
                                         std::span<const EnrolmentRange> ranges);

/// The first number of a station that is not taken.
/// \param source  name of the plan's file, for error messages
/// \throws StudyError with the remedy if the plan has no such station, or all its numbers are taken
[[nodiscard]] int next_of_station(const EnrolmentPlan& plan, const std::string& station,
                                  const std::set<int>& taken, const std::string& source);

/// \return the name of the station that has a number; null if none has it
[[nodiscard]] const std::string* station_of(const EnrolmentPlan& plan, int number) noexcept;

/// `<study>.plan.json` beside the study file.
[[nodiscard]] std::filesystem::path plan_path_for(const std::filesystem::path& study_file);

/// Reads a plan strictly.
/// \throws StudyError with file and JSON pointer if the file is not a plan, numbers overlap or are
///   missing, or the plan belongs to another study
/// \throws FileError if the file cannot be read
[[nodiscard]] EnrolmentPlan load_plan(const std::filesystem::path& path, const Study& study);
/// \throws FileError if the file cannot be written
void save_plan(const std::filesystem::path& path, const EnrolmentPlan& plan);

}  // namespace touchtrial::design
