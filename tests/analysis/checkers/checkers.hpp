/// \file Checkers of files that others read, written in Python from the files' specifications: what
/// each finds is said there. Every fault is one line; empty: none that the checker knows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {

/// dataset_rules.py on a BIDS dataset of behaviour.
[[nodiscard]] std::vector<std::string> bids_faults(const std::filesystem::path& dataset);
/// dataset_rules.py on a Psych-DS dataset.
[[nodiscard]] std::vector<std::string> psych_ds_faults(const std::filesystem::path& dataset);
/// page_rules.py on a page.
[[nodiscard]] std::vector<std::string> faults_of_page(const std::string& html);

}  // namespace touchtrial
