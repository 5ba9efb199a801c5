/// \file The investigator's key as lines that people can copy from paper: the master secret, from
/// which all other secrets follow, and what the stations were given. Each line ends with four check
/// digits, so that a typing error is found in its line. Format: docs/data-dictionary.md, "Recovery
/// sheet".
#pragma once

#include "protocols/design/study_key.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::design {

/// The key that follows from a master secret.
/// \param stations  with their numbers; their secrets are derived
[[nodiscard]] StudyKey key_from_master(const SecretKey& master, const Study& study,
                                       std::vector<Station> stations, bool simulated);

/// The lines of a key's sheet, without their numbers, which count from 1.
/// \throws UsageError if there would be more than 9999
[[nodiscard]] std::vector<std::string> recovery_lines(const StudyKey& key);

/// Collects the lines of a sheet, in any order.
class RecoveryReader {
 public:
  /// Takes a line such as "3: 9c1f 0b7a 66d2 e410 5b3c". A text without a number and a colon at
  /// its beginning is passed over, so that a whole page can be read.
  /// \return whether the text was a line of a sheet
  /// \throws UsageError, naming the line, if it is not what was printed
  bool take(std::string_view text);

  /// The number of the first line that is missing; 0 if all are there.
  [[nodiscard]] int missing() const;

  /// The key for this study.
  /// \throws UsageError if a line is missing, or the lines are of different sheets
  [[nodiscard]] StudyKey key_for(const Study& study) const;
  /// Whether the study is the one for which the sheet was printed. If not, the key opens every
  /// session all the same; but databases name the seal of the study as it was.
  [[nodiscard]] bool is_sealed_as(const StudyKey& key) const;

 private:
  /// The number of lines that the sheet has, as line 5 says.
  [[nodiscard]] int count() const;
  [[nodiscard]] std::vector<Station> stations() const;

  std::map<int, std::string> lines_;  ///< without their check digits, by number
};

}  // namespace touchtrial::design
