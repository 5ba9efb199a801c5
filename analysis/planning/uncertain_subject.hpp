/// \file A fitted subject with what its fit leaves open, for the assurance of a study: its power over
/// that uncertainty. Source: docs/power.md, "Assurance"; O'Hagan, Stevens and Campbell 2005,
/// doi:10.1002/pst.175.
#pragma once

#include "protocols/simulation/subject_model.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::planning {

struct UncertainSubject {
  simulation::SubjectModel subject;  ///< fitted, with the device of the fit
  /// The same subject by each draw of the fit; they differ in noise, lapse and biases alone, so
  /// that all of them feel and learn alike. At least one.
  std::vector<simulation::SubjectModel> draws;
};

/// Reads what `touchtrial fit DB --json` prints.
/// \throws FileError if the file cannot be read, is not such a fit, or has no draws (it was made of
///   published accuracies, or with --bootstraps 0); StudyError if its subject or device is refused
[[nodiscard]] UncertainSubject load_uncertain_subject(const std::filesystem::path& file);

/// \return the fitted subject on one line, with the number of draws and a digest of them all
[[nodiscard]] std::string words_of(const UncertainSubject& uncertain);

}  // namespace touchtrial::planning
