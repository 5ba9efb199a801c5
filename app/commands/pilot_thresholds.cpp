#include "app/commands/pilot_thresholds.hpp"

#include "analysis/planning/planner.hpp"
#include "app/commands/study_inputs.hpp"
#include "core/errors.hpp"
#include "device/drivers/registry.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/stimulus_levels.hpp"
#include "record/study_store.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

/// The place in the study file that names the pilots' database.
std::string location_of(const study::Study& study) {
  return study.source + ": /rendering/gains/curve: " + study.level->curve;
}

[[noreturn]] void refuse(const study::Study& study, const std::string& problem) {
  throw StudyError(one_line(location_of(study) + ": " + problem));
}

/// The mean threshold of each stimulus that has one, dB.
std::vector<std::pair<std::string, double>> means_of(const study::Study& study,
                                                     const record::StudyStore& store,
                                                     const study::StudyKey& key) {
  if (!store.state().unblinded) refuse(study, "is not unblinded; close and unblind it");
  const planning::Planner& planner = planning::planner_of(key.study, "thresholds of pilots");
  return planner.pilot_thresholds(outcomes_of(store, key), location_of(study));
}

/// Refuses thresholds that were measured on another device.
void require_device(const study::Study& study, const record::StudyStore& store,
                    const study::Study& pilots, const device::DeviceModel& device) {
  const device::DeviceDriver* const driver = device::driver_of_model(device.name);
  std::string measured_device;
  for (const record::SessionRow& session : store.sessions()) {
    if (session.erased || session.excluded || !session.replaced_by.empty()) continue;
    const bool is_same = session.simulated ? session.device == device::simulated_device_name(device)
                                           : driver == nullptr || session.device == driver->name;
    if (!is_same) measured_device = session.device;
  }
  if (measured_device.empty() && !pilots.device.empty()) {
    const std::string stated_name = simulation::device_of(pilots).name;
    if (stated_name != device.name) measured_device = stated_name;
  }
  if (measured_device.empty()) return;
  refuse(study, fmt::format("its thresholds were measured on '{}', and this study is for {}; "
                            "measure them on that device, or change /rendering/device",
                            measured_device, device.name));
}

simulation::LevelCurve pilots_curve(const study::Study& study, const device::DeviceModel& device) {
  const std::filesystem::path database = study.folder / study.level->curve;
  const record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_only);
  if (!path_exists(key_in_use(database, {}))) {
    refuse(study, "has no key beside it; put its study's key there as " +
                      key_path_for(database, {}).string());
  }
  if (const auto fault = store.first_fault(record::TraceCheck::skip)) {
    refuse(study, "is damaged or was altered; `touchtrial verify` shows where");
  }
  const study::StudyKey key = key_of_database(store, database, {});
  require_device(study, store, key.study, device);
  const auto means = means_of(study, store, key);
  const engine::Pack pack(key.pack_folder);
  const session::StimulusSource source(pack, key.study.rendering);
  const simulation::StimulusLevels levels = simulation::levels_of(key, source, {device}, cores());
  double sum = 0.0;
  for (const auto& [label, measured_db] : means) {
    const auto stimulus = std::ranges::find(levels.stimuli, label, [&](const auto& index) {
      return key.study.classes[static_cast<std::size_t>(index.class_index)].label;
    });
    if (stimulus == levels.stimuli.end()) refuse(study, "contains no field for " + label);
    const auto level_index = static_cast<std::size_t>(stimulus - levels.stimuli.begin());
    // The level of the full gain is its distance above the threshold.
    sum += measured_db + levels.levels[level_index].front().db;
  }
  return {.curve = engine::ThresholdCurve::israr_2006,
          .pilots_db = sum / static_cast<double>(means.size()),
          .simulated_pilots = store.commitment().simulated};
}

}  // namespace

simulation::LevelCurve curve_of(const study::Study& study, const device::DeviceModel& device) {
  for (const engine::ThresholdCurve curve : engine::kThresholdCurves) {
    if (study.level.value().curve == engine::name_of(curve)) return {curve, {}};
  }
  try {
    return pilots_curve(study, device);
  } catch (const StudyError&) {
    throw;
  } catch (const Error& error) {
    throw StudyError(one_line(study.source + ": /rendering/gains/curve: " + error.what()));
  }
}

}  // namespace touchtrial::app
