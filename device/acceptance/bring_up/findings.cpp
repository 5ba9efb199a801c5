/// \file The record of a bring-up, its file, the signs of axes, and detection of simulated hardware.
#include "device/acceptance/bring_up/findings.hpp"

#include "core/hash.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "device/acceptance/bring_up/bring_up.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <dlfcn.h>
#include <link.h>
#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

constexpr std::array<std::string_view, kBringUpSteps> kStepNames = {
    "open",   "rest", "ways",    "push",  "steps",    "range",
    "weight", "wall", "program", "cable", "questions"};
constexpr std::array<std::string_view, 5> kOutcomeNames = {"not_reached", "interrupted", "left_out",
                                                           "failed", "done"};
constexpr std::array<std::string_view, 4> kEndNames = {"stopped", "complete", "wrong_sign",
                                                       "fault"};

constexpr double kMaxBackwardMm = 2.0;

/// Words in the names of simulated devices.
constexpr std::array<std::string_view, 8> kStandInWords = {"simul", "emul",  "virtual",  "fake",
                                                           "mock",  "dummy", "stand-in", "standin"};

/// \return the finding's three numbers as a vector; zeros if it does not have three
Vec3 vec_of(const Finding* finding) {
  if (finding == nullptr || finding->numbers.size() != 3) return {};
  return {finding->numbers[0], finding->numbers[1], finding->numbers[2]};
}

Finding& find_or_add(std::vector<Finding>& findings, const std::string& name) {
  const auto found = std::ranges::find(findings, name, &Finding::name);
  return found == findings.end() ? findings.emplace_back(Finding{name}) : *found;
}

bool is_stand_in_name(std::string text) {
  std::ranges::transform(text, text.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return std::ranges::any_of(
      kStandInWords, [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

/// \return the driver's library in the settings; empty: none
std::filesystem::path library_of(const std::string& driver, const DeviceSettings& settings) {
  if (driver == "dhd") return settings.dhd.library;
  if (driver == "openhaptics") return settings.openhaptics.library;
  return driver == "plugin" ? settings.plugin.library : std::filesystem::path();
}

struct LoadedLibrary {
  std::filesystem::path configured_name;  ///< name in the settings
  std::filesystem::path file;             ///< canonical path of the library loaded by that name
  bool has_symbol = false;                ///< whether it has the symbol of a stand-in
};

LoadedLibrary loaded_library(const std::filesystem::path& configured_name) {
  LoadedLibrary library{configured_name, configured_name};
  if (configured_name.empty()) return library;
  std::error_code ignored;
  if (void* const handle = dlopen(configured_name.c_str(), RTLD_LAZY | RTLD_NOLOAD)) {
    link_map* map = nullptr;
    if (dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0) library.file = map->l_name;
    library.has_symbol = dlsym(handle, "touchtrial_stand_in") != nullptr;
    dlclose(handle);
  }
  library.file = std::filesystem::weakly_canonical(library.file, ignored);
  return library;
}

/// Detects a bus of umockdev or of the kernel's USB emulator. A bus over a network does not count,
/// because real devices may be connected to it.
bool is_usb_emulated() {
  if (std::getenv("UMOCKDEV_DIR") != nullptr) return true;
  std::error_code ignored;
  const std::filesystem::directory_iterator controllers("/sys/bus/platform/drivers/dummy_hcd",
                                                        ignored);
  return std::any_of(begin(controllers), end(controllers), [](const auto& entry) {
    return entry.path().filename().string().starts_with("dummy_hcd.");
  });
}

/// Writes several numbers as one text, because a JSON list would need a line for each.
nlohmann::ordered_json value_of(const Finding& finding) {
  if (!finding.word.empty()) return finding.word;
  if (finding.numbers.size() == 1) return finding.numbers.front();
  std::string text;
  for (const double number : finding.numbers) {
    text += (text.empty() ? "" : " ") + number_text(number);
  }
  return text;
}

}  // namespace

std::string_view name_of(BringUpStep step) noexcept {
  return kStepNames.at(static_cast<std::size_t>(step));
}
std::string_view name_of(StepOutcome outcome) noexcept {
  return kOutcomeNames.at(static_cast<std::size_t>(outcome));
}
std::string_view name_of(BringUpEnd end) noexcept {
  return kEndNames.at(static_cast<std::size_t>(end));
}

const Finding* BringUp::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(findings, name, &Finding::name);
  return found == findings.end() ? nullptr : &*found;
}

double BringUp::number(std::string_view name) const noexcept {
  const Finding* const found = find(name);
  return found == nullptr || found->numbers.empty() ? 0.0 : found->numbers.front();
}

void BringUp::note(const std::string& name, std::vector<double> numbers) {
  Finding& finding = find_or_add(findings, name);
  finding.numbers = std::move(numbers);
}

void BringUp::note(const std::string& name, std::string_view word) {
  find_or_add(findings, name).word = word;
}

std::string signed_name(int sign, DeviceAxis axis) {
  return (sign > 0 ? "+" : "-") + std::string(name_of(axis));
}

bool followed_axis(const BringUp& record, DeviceAxis axis) {
  const Vec3 moved_mm = vec_of(record.find("carried_mm " + std::string(name_of(axis))));
  const double along_mm = dot(moved_mm, direction_of(axis));
  return along_mm > norm(moved_mm - along_mm * direction_of(axis));
}

PushSign sign_of_push(const BringUp& record, DeviceAxis axis, int sign) {
  const std::string name = signed_name(sign, axis);
  const Finding* const felt = record.find("felt " + name);
  if (felt == nullptr || felt->word == kPushDirections.back()) return PushSign::not_felt;
  const std::size_t pair = axis == DeviceAxis::x ? 0 : axis == DeviceAxis::y ? 2 : 4;
  const double along_mm = sign * dot(vec_of(record.find("moved_mm " + name)), direction_of(axis));
  const bool is_expected_direction = felt->word == kPushDirections.at(pair + (sign > 0 ? 0 : 1));
  return is_expected_direction && along_mm >= -kMaxBackwardMm ? PushSign::correct : PushSign::wrong;
}

bool BringUp::signs_confirmed() const {
  return std::ranges::all_of(kDeviceAxes, [&](DeviceAxis axis) {
    return followed_axis(*this, axis) && sign_of_push(*this, axis, 1) == PushSign::correct &&
           sign_of_push(*this, axis, -1) == PushSign::correct;
  });
}

std::string stand_in_of(const DeviceInfo& device, const DeviceSettings& settings) {
  if (device.simulated) return "the driver simulates a device";
  if (device.visual) return "the driver has no motors";
  for (const std::string& text : {device.model, device.firmware, device.library, device.serial}) {
    if (is_stand_in_name(text)) return "the device or its library calls itself a stand-in";
  }
  const LoadedLibrary library = loaded_library(library_of(device.name, settings));
  if (library.has_symbol) return "the library identifies itself as a stand-in";
  if (is_stand_in_name(library.configured_name.string()) ||
      is_stand_in_name(library.file.string())) {
    return "the library's file or folder has a stand-in's name";
  }
  return is_usb_emulated() ? "a USB bus of the machine is emulated" : "";
}

BringUp bring_up_of(const DeviceInfo& device) {
  const auto without_serial = [&](std::string text) {
    for (std::size_t start = 0; !device.serial.empty() &&
                                (start = text.find(device.serial, start)) != std::string::npos;) {
      text.replace(start, device.serial.size(), "#");
    }
    return text;
  };
  BringUp record;
  record.driver = device.name;
  record.model = without_serial(device.model);
  record.firmware = without_serial(device.firmware);
  record.library = without_serial(device.library);
  if (!device.serial.empty()) {
    FieldHasher hasher;
    hasher.add("touchtrial bring-up");
    hasher.add(device.name);
    hasher.add(device.serial);
    record.device_mark = to_hex(hasher.finish()).substr(0, 4);
  }
  const auto add_if_positive = [&](const char* name, double number) {
    if (number > 0.0) record.note(name, {number});
  };
  add_if_positive("peak_force_n", device.max_force_n);
  add_if_positive("continuous_force_n", device.continuous_force_n);
  add_if_positive("max_stiffness_n_per_mm", device.max_stiffness_n_per_mm);
  // Meaningful only if the stiffness is known.
  if (device.max_stiffness_n_per_mm > 0.0)
    add_if_positive("max_damping_n_s_per_mm", device.max_damping_n_s_per_mm);
  add_if_positive("max_rate_hz", device.max_rate_hz);
  if (device.workspace) add_extent(record, "workspace_mm ", *device.workspace);
  record.outcome(BringUpStep::open) = StepOutcome::done;
  return record;
}

void add_extent(BringUp& record, const std::string& name, const Workspace& extent) {
  for (const DeviceAxis axis : kDeviceAxes) {
    const Vec3 along = direction_of(axis);
    record.note(name + std::string(name_of(axis)),
                {dot(extent.min_mm, along), dot(extent.max_mm, along)});
  }
}

std::string bring_up_json(const BringUp& record) {
  using nlohmann::ordered_json;
  ordered_json file = {{"kind", "touchtrial device bring-up 2"},
                       {"program", record.program},
                       {"driver", record.driver},
                       {"device_mark", record.device_mark},
                       {"model", record.model},
                       {"firmware", record.firmware},
                       {"library", record.library},
                       {"stand_in", record.stand_in},
                       {"scheduling", record.scheduling},
                       {"memory_locked", record.memory_locked},
                       {"ended", name_of(record.ended)},
                       {"why", record.reason}};
  for (std::size_t i = 0; i < kBringUpSteps; ++i) {
    file["steps"][std::string(kStepNames[i])] = name_of(record.outcomes.at(i));
  }
  ordered_json& findings = file["findings"] = ordered_json::array();
  for (const Finding& finding : record.findings) {
    findings.push_back({{"name", finding.name}, {"value", value_of(finding)}});
  }
  return json_text(file);
}

}  // namespace touchtrial::device
