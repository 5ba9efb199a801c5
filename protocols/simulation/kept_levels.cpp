#include "protocols/simulation/kept_levels.hpp"

#include "protocols/design/private_notes.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial::simulation {
namespace {

using nlohmann::json;

/// Of everything that decides levels.
std::string identity_of(const design::StudyKey& key, const engine::Pack& pack,
                        const std::vector<device::DeviceModel>& devices) {
  FieldHasher hasher;
  hasher.add(ByteView(key.seal)).add(ByteView(pack.digest()));
  for (const device::DeviceModel& device : devices) hasher.add(device::device_model_json(device));
  return to_hex(hasher.finish());
}

json json_of(const PlaneLevels& plane) {
  json levels = json::array();
  for (const StimulusLevel& level : plane) {
    levels.push_back({level.device, static_cast<int>(level.curve), level.db, level.bands_db});
  }
  return levels;
}

PlaneLevels plane_in(const json& levels) {
  PlaneLevels plane;
  for (const json& level : levels) {
    plane.push_back({.device = level.at(0).get<std::string>(),
                     .curve = engine::kThresholdCurves.at(level.at(1).get<std::size_t>()),
                     .db = level.at(2).get<double>(),
                     .bands_db = level.at(3).get<decltype(StimulusLevel::bands_db)>()});
  }
  return plane;
}

std::string text_of_levels(const std::string& identity, const StimulusLevels& found) {
  json all = {{"of", identity}, {"stimuli", json::array()}, {"blank", json_of(found.blank)}};
  for (std::size_t i = 0; i < found.stimuli.size(); ++i) {
    const design::StimulusIndex& stimulus = found.stimuli[i];
    all["stimuli"].push_back(
        {stimulus.class_index, stimulus.exemplar, stimulus.method, json_of(found.levels[i])});
  }
  return all.dump();
}

/// \return nothing if the text is of something else, or damaged
std::optional<StimulusLevels> levels_in(const std::string& text, const std::string& identity) {
  try {
    const json all = json::parse(text);
    if (all.at("of") != identity) return std::nullopt;
    StimulusLevels found;
    found.blank = plane_in(all.at("blank"));
    for (const json& stimulus : all.at("stimuli")) {
      found.stimuli.push_back(
          {stimulus.at(0).get<int>(), stimulus.at(1).get<int>(), stimulus.at(2).get<int>()});
      found.levels.push_back(plane_in(stimulus.at(3)));
    }
    return found;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace

StimulusLevels kept_levels_of(const design::StudyKey& key, const engine::Pack& pack,
                              const std::vector<device::DeviceModel>& devices, int jobs,
                              const std::filesystem::path& notes) {
  const design::PrivateNotes kept(notes, key.master, "levels");
  const std::string identity = identity_of(key, pack, devices);
  if (const auto text = kept.read()) {
    if (auto levels = levels_in(*text, identity)) return *std::move(levels);
  }
  const session::StimulusSource source(pack, key.study.rendering);
  StimulusLevels levels = levels_of(key, source, devices, jobs);
  kept.keep(text_of_levels(identity, levels));
  return levels;
}

}  // namespace touchtrial::simulation
