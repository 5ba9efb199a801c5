/// \file Simulates a whole study, from its file to its database.
#pragma once

#include "protocols/simulation/simulation.hpp"

#include <filesystem>
#include <string>

namespace touchtrial::app {

struct StudyToSimulate {
  std::filesystem::path study;     ///< its file
  std::filesystem::path database;  ///< the file to create; the key is written beside it
  std::filesystem::path subject;   ///< a subject model; empty: the built-in one
  std::string hand_device;         ///< the simulated hands' device, as in subject_for
  simulation::SimulationOptions options;
  bool keep_blind = false;  ///< do not close and unblind the study
};

/// Prepares the study's pack, simulates its sessions, and closes and unblinds it. Shows progress on
/// a terminal.
/// \throws StoreError if the database, or another study's key, exists already
/// \throws as load_study, subject_for, prepare_pack and simulation::simulate_study
simulation::SimulationReport simulate_study(const StudyToSimulate& request);

/// The result, as `simulate --json` prints it.
[[nodiscard]] std::string simulation_json(const StudyToSimulate& request,
                                          const simulation::SimulationReport& report);

}  // namespace touchtrial::app
