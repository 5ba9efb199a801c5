/// \file Which station has which numbers of enrolment, decided before anybody comes: several
/// stations then keep an order balanced without speaking to each other.
/// Format: docs/several-stations.md, "Handing out enrolment numbers".
#pragma once

#include "protocols/design/study.hpp"

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::design {

/// Numbers that follow each other; both ends belong to it.
struct EnrolmentRange {
  int first = 1;
  int last = 1;  ///< >= first

  [[nodiscard]] int size() const noexcept { return last - first + 1; }
  friend bool operator==(const EnrolmentRange&, const EnrolmentRange&) = default;
};

/// One station's numbers.
struct StationShare {
  std::string station;  ///< its name, a participant id's letters; unique
  std::vector<EnrolmentRange> ranges;

  [[nodiscard]] int size() const noexcept;
  friend bool operator==(const StationShare&, const StationShare&) = default;
};

/// Every number from 1 to the last that was handed out belongs to one station.
struct EnrolmentPlan {
  std::string study;  ///< its name
  std::vector<StationShare> stations;

  /// Numbers handed out so far, which are 1 to this.
  [[nodiscard]] int participants() const noexcept;
  friend bool operator==(const EnrolmentPlan&, const EnrolmentPlan&) = default;
};

inline constexpr int kMostPlanned = 1'000'000;
inline constexpr std::size_t kMostStations = 1000;

/// Hands numbers to stations until there are so many: stations differ by one participant at most,
/// as far as what they have already allows. A station gets numbers that follow each other, as long
/// as these keep its orders of methods as even as can be. Numbers of `plan` stay where they are.
/// \param participants  in all, from those that `plan` has to kMostPlanned
/// \throws std::invalid_argument if it has no stations or `participants` is out of range
void extend_plan(EnrolmentPlan& plan, const Study& study, int participants);

/// A plan without numbers. \param stations  1 to kMostStations names
/// \throws UsageError if a name is not 1 to 32 of [0-9A-Za-z+-_], or there twice
[[nodiscard]] EnrolmentPlan empty_plan(const Study& study, std::span<const std::string> stations);

/// How often each order of method blocks comes in some numbers: one count for each row of the
/// Williams design.
[[nodiscard]] std::vector<int> orders_of(const Study& study,
                                         std::span<const EnrolmentRange> ranges);

/// The smallest number of a station that is not taken.
/// \param source  of the plan, for errors
/// \throws StudyError with the remedy if the plan has no such station, or all its numbers are taken
[[nodiscard]] int next_of_station(const EnrolmentPlan& plan, const std::string& station,
                                  const std::set<int>& taken, const std::string& source);

/// The name of the station that has a number; null: none has.
[[nodiscard]] const std::string* station_of(const EnrolmentPlan& plan, int number) noexcept;

/// `<study>.plan.json` beside the study file.
[[nodiscard]] std::filesystem::path plan_path_for(const std::filesystem::path& study_file);

/// Reads a plan strictly. \throws StudyError with file and JSON pointer if it is no plan, numbers
///   overlap or are left out, or it is another study's; FileError if it cannot be read
[[nodiscard]] EnrolmentPlan load_plan(const std::filesystem::path& path, const Study& study);
/// \throws FileError if it cannot be written
void save_plan(const std::filesystem::path& path, const EnrolmentPlan& plan);

}  // namespace touchtrial::design
