/// \file Checkers of datasets, written from their specifications, so that no test needs a network.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {

/// What is wrong with a BIDS dataset of behaviour; empty: nothing.
/// Source: BIDS specification 1.11.1 and its schema: "Common principles", "Modality agnostic
/// files", "Behavioral experiments (with no neural recordings)", "Motion".
[[nodiscard]] std::vector<std::string> bids_faults(const std::filesystem::path& dataset);

/// What is wrong with a Psych-DS dataset; empty: nothing. Source: Psych-DS schema 1.5.1.
[[nodiscard]] std::vector<std::string> psych_ds_faults(const std::filesystem::path& dataset);

}  // namespace touchtrial
