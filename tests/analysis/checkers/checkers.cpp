#include "analysis/checkers/checkers.hpp"

#include "support/child_process.hpp"

#include <sstream>

namespace touchtrial {
namespace {

/// What a checker prints, by line; a checker that fails prints why.
std::vector<std::string> printed_by(const std::vector<std::string>& checker,
                                    const std::string& input = "") {
  std::vector<std::string> command{"/usr/bin/python3",
                                   TOUCHTRIAL_SOURCE_DIR "/tests/analysis/checkers/" + checker[0]};
  command.insert(command.end(), checker.begin() + 1, checker.end());
  testing::ChildProcess process(command, {});
  process.write(input);
  process.close_input();
  const int exit_code = process.finish();
  std::vector<std::string> lines;
  std::istringstream output(process.output());
  for (std::string line; std::getline(output, line);) {
    if (!line.empty()) lines.push_back(line);
  }
  if (exit_code != 0) lines.push_back(checker[0] + " failed");
  return lines;
}

}  // namespace

std::vector<std::string> bids_faults(const std::filesystem::path& dataset) {
  return printed_by({"dataset_rules.py", "bids", dataset.string()});
}

std::vector<std::string> psych_ds_faults(const std::filesystem::path& dataset) {
  return printed_by({"dataset_rules.py", "psych-ds", dataset.string()});
}

std::vector<std::string> faults_of_page(const std::string& html) {
  return printed_by({"page_rules.py"}, html);
}

}  // namespace touchtrial
