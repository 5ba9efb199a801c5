// What each step of a bring-up may find, what that shows of a device's facts, and what does not
// count.
#include "device/bring_up/findings.hpp"

#include "core/hash.hpp"
#include "device/bring_up/bring_up.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

namespace touchtrial::device {
namespace {

constexpr std::array<std::string_view, kBringUpSteps> kStepNames = {
    "open",   "rest", "ways",    "push",  "steps",    "range",
    "weight", "wall", "program", "cable", "questions"};
constexpr std::array<std::string_view, 5> kOutcomeNames = {"not_reached", "interrupted", "left_out",
                                                           "failed", "done"};
constexpr std::array<std::string_view, 4> kEndNames = {"stopped", "complete", "wrong_sign",
                                                       "fault"};

constexpr std::array<std::string_view, 9> kAxes = {" x",  " y",  " z",  " +x", " -x",
                                                   " +y", " -y", " +z", " -z"};
constexpr std::array<std::string_view, 2> kWallWords = {"steady", "swung"};
/// Names of SafetyFault and DeviceFault.
constexpr std::array<std::string_view, 14> kFaults = {
    "none",     "not_finite",   "emergency_stop",  "not_ready", "overspeed",
    "stalled",  "stale_sample", "frozen_encoders", "device",    "link_lost",
    "bad_data", "warm_motors",  "limit_passed",    "driver"};

using enum BringUpStep;
constexpr std::array kKinds = {
    FindingKind{open, "peak force", "N"},
    FindingKind{open, "continuous force", "N"},
    FindingKind{open, "max stiffness", "N/mm"},
    FindingKind{open, "max damping", "N s/mm", Evidence::limits},
    FindingKind{open, "max rate", "Hz"},
    FindingKind{open, "workspace", "mm"},
    FindingKind{rest, "noise", "mm"},
    FindingKind{rest, "drift", "mm"},
    FindingKind{rest, "ticks", "Hz"},
    FindingKind{rest, "new readings", "Hz", Evidence::readings},
    FindingKind{rest, "longest gap", "ms"},
    FindingKind{rest, "late p50", "us"},
    FindingKind{rest, "late p99", "us"},
    FindingKind{rest, "late worst", "us"},
    FindingKind{rest, "overruns"},
    FindingKind{ways, "carried", "mm"},
    FindingKind{ways, "ruler", "mm", Evidence::lengths},
    FindingKind{push, "push", "N"},
    FindingKind{push, "felt", "", Evidence::none, kSides},
    FindingKind{push, "moved", "mm"},
    FindingKind{steps, "encoder step", "mm"},
    FindingKind{range, "reach", "mm", Evidence::range},
    FindingKind{weight, "load", "N"},
    FindingKind{weight, "friction", "N"},
    FindingKind{weight, "weight", "N"},
    FindingKind{weight, "commanded for it", "N"},
    FindingKind{weight, "force scale and error", "", Evidence::weight},
    FindingKind{wall, "stiffness", "N/mm"},
    FindingKind{wall, "contact", "s"},
    FindingKind{wall, "wall", "", Evidence::wall, kWallWords},
    FindingKind{wall, "delivered share", "", Evidence::delivered},
    FindingKind{wall, "time", "ms"},
    FindingKind{wall, "height", "um"},
    FindingKind{wall, "force up", "mN"},
    FindingKind{program, "force without program", "", Evidence::program_silent, kSilences},
    FindingKind{program, "fault without program", "", Evidence::none, kFaults},
    FindingKind{cable, "force without cable", "", Evidence::cable_silent, kSilences},
    FindingKind{cable, "fault without cable", "", Evidence::none, kFaults}};

constexpr double kAgainstMm = 2.0;

/// Words that makers of simulators use for their devices.
constexpr std::array<std::string_view, 8> kStandInWords = {"simul", "emul",  "virtual",  "fake",
                                                           "mock",  "dummy", "stand-in", "standin"};

/// \return zeros for what is no vector
Vec3 vec_of(const Finding* finding) {
  if (finding == nullptr || finding->numbers.size() != 3) return {};
  return {finding->numbers[0], finding->numbers[1], finding->numbers[2]};
}

/// What no kind knows is the answer to a question.
Finding& noted(std::vector<Finding>& findings, const std::string& name) {
  const auto same = std::ranges::find(findings, name, &Finding::name);
  if (same != findings.end()) return *same;
  const FindingKind* const kind = kind_of(name);
  findings.push_back(kind == nullptr ? Finding{questions, name}
                                     : Finding{kind->step, name, std::string(kind->unit)});
  return findings.back();
}

/// Whether numbers of a finding can have been measured.
bool is_possible(const Finding& finding, Evidence evidence) {
  const std::vector<double>& n = finding.numbers;
  switch (evidence) {
    case Evidence::lengths:
      return n.size() == 1 && n[0] >= 1.0 && n[0] <= 500.0;
    case Evidence::range:
      return n.size() == 2 && n[0] < n[1];
    case Evidence::weight:
      return n.size() == 2 && n[0] > 0.0 && n[1] >= 0.0;
    default:
      return n.size() == 1 && n[0] > 0.0;
  }
}

/// Whether readings of a way or a push, not the end alone, say that a sign is wrong.
bool found_wrong(const BringUp& record) {
  return std::ranges::any_of(kDeviceAxes, [&](DeviceAxis axis) {
    const bool was_carried = norm(vec_of(record.find("carried " + std::string(name_of(axis))))) > 0;
    const auto is_wrong = [&](int sign) {
      const Finding* const moved = record.find("moved " + signed_name(sign, axis));
      return moved != nullptr && moved->numbers.size() == 3 &&
             sign_of_push(record, axis, sign) == PushSign::wrong;
    };
    return (was_carried && !was_carried_right(record, axis)) || is_wrong(1) || is_wrong(-1);
  });
}

bool names_a_stand_in(std::string text) {
  std::ranges::transform(text, text.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return std::ranges::any_of(
      kStandInWords, [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

/// \return the file that the settings name for a driver; empty: it has none
std::filesystem::path library_of(const std::string& driver, const DeviceSettings& settings) {
  if (driver == "dhd") return settings.dhd.library;
  if (driver == "openhaptics") return settings.openhaptics.library;
  return driver == "plugin" ? settings.plugin.library : std::filesystem::path();
}

struct LoadedLibrary {
  std::filesystem::path named;  ///< by the settings
  std::filesystem::path file;   ///< canonical, of what the process has loaded by that name
  bool says_so = false;         ///< it has the symbol of a stand-in
};

LoadedLibrary loaded_library(const std::filesystem::path& named) {
  LoadedLibrary library{named, named};
  if (named.empty()) return library;
  std::error_code none;
  if (void* const handle = dlopen(named.c_str(), RTLD_LAZY | RTLD_NOLOAD)) {
    link_map* map = nullptr;
    if (dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0) library.file = map->l_name;
    library.says_so = dlsym(handle, "touchtrial_stand_in") != nullptr;
    dlclose(handle);
  }
  library.file = std::filesystem::weakly_canonical(library.file, none);
  return library;
}

/// A bus of umockdev, or of the kernel's own emulator of USB devices. A bus over a network is none:
/// real devices hang on it too.
bool usb_is_emulated() {
  if (std::getenv("UMOCKDEV_DIR") != nullptr) return true;
  std::error_code none;
  const std::filesystem::directory_iterator controllers("/sys/bus/platform/drivers/dummy_hcd",
                                                        none);
  return std::any_of(begin(controllers), end(controllers), [](const auto& entry) {
    return entry.path().filename().string().starts_with("dummy_hcd.");
  });
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

const FindingKind* kind_of(std::string_view name) noexcept {
  const auto named = [](std::string_view wanted) {
    const auto found = std::ranges::find(kKinds, wanted, &FindingKind::name);
    return found == kKinds.end() ? nullptr : &*found;
  };
  if (const FindingKind* const kind = named(name)) return kind;
  const std::size_t end = std::min(name.rfind(' '), name.size());
  const bool is_of_axis = std::ranges::find(kAxes, name.substr(end)) != kAxes.end();
  return is_of_axis ? named(name.substr(0, end)) : nullptr;
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
  Finding& finding = noted(findings, name);
  finding.numbers = std::move(numbers);
}

void BringUp::note(const std::string& name, std::string_view word) {
  noted(findings, name).word = word;
}

std::string signed_name(int sign, DeviceAxis axis) {
  return (sign > 0 ? "+" : "-") + std::string(name_of(axis));
}

bool was_carried_right(const BringUp& record, DeviceAxis axis) {
  const Vec3 moved_mm = vec_of(record.find("carried " + std::string(name_of(axis))));
  const double along_mm = dot(moved_mm, direction_of(axis));
  return along_mm > norm(moved_mm - along_mm * direction_of(axis));
}

PushSign sign_of_push(const BringUp& record, DeviceAxis axis, int sign) {
  const std::string name = signed_name(sign, axis);
  const Finding* const felt = record.find("felt " + name);
  if (felt == nullptr || felt->word == kSides.back()) return PushSign::not_felt;
  const std::size_t pair = axis == DeviceAxis::x ? 0 : axis == DeviceAxis::y ? 2 : 4;
  const double along_mm = sign * dot(vec_of(record.find("moved " + name)), direction_of(axis));
  const bool is_right = felt->word == kSides.at(pair + (sign > 0 ? 0 : 1));
  return is_right && along_mm >= -kAgainstMm ? PushSign::right : PushSign::wrong;
}

bool BringUp::signs_confirmed() const {
  return std::ranges::all_of(kDeviceAxes, [&](DeviceAxis axis) {
    return was_carried_right(*this, axis) && sign_of_push(*this, axis, 1) == PushSign::right &&
           sign_of_push(*this, axis, -1) == PushSign::right;
  });
}

bool BringUp::settles(const UnverifiedFact& fact) const {
  if (!stand_in_of(*this).empty() || fact.evidence == Evidence::none) return false;
  if (fact.evidence == Evidence::answer) {
    return outcome(questions) == StepOutcome::done && find(fact.id) != nullptr;
  }
  if (fact.evidence == Evidence::signs) {
    const bool all_done = outcome(ways) == StepOutcome::done && outcome(push) == StepOutcome::done;
    return (all_done && signs_confirmed()) ||
           (ended == BringUpEnd::wrong_sign && found_wrong(*this));
  }
  const Evidence evidence = fact.evidence == Evidence::opened ? Evidence::readings : fact.evidence;
  return std::ranges::any_of(findings, [&](const Finding& finding) {
    const FindingKind* const kind = kind_of(finding.name);
    return finding.step != questions && kind != nullptr && kind->shows == evidence &&
           outcome(finding.step) == StepOutcome::done &&
           (kind->words.empty() ? is_possible(finding, evidence) : !finding.word.empty());
  });
}

std::string stand_in_of(const DeviceInfo& device, const DeviceSettings& settings) {
  if (device.simulated) return "the driver simulates a device";
  if (device.visual) return "the driver has no motors";
  for (const std::string& text : {device.model, device.firmware, device.library, device.serial}) {
    if (names_a_stand_in(text)) return "the device or its library calls itself a stand-in";
  }
  const LoadedLibrary library = loaded_library(library_of(device.name, settings));
  if (library.says_so) return "the library says that it is a stand-in";
  if (names_a_stand_in(library.named.string()) || names_a_stand_in(library.file.string())) {
    return "the library's file or folder has a stand-in's name";
  }
  return usb_is_emulated() ? "a USB bus of the machine is emulated" : "";
}

std::string stand_in_of(const BringUp& record) {
  if (!record.stand_in.empty()) return record.stand_in;
  const bool is_named = names_a_stand_in(record.model) || names_a_stand_in(record.firmware) ||
                        names_a_stand_in(record.library);
  return is_named ? "the device or its library calls itself a stand-in" : "";
}

BringUp bring_up_of(const DeviceInfo& device) {
  const auto anonymous = [&](std::string text) {
    for (std::size_t at = 0;
         !device.serial.empty() && (at = text.find(device.serial, at)) != std::string::npos;) {
      text.replace(at, device.serial.size(), "#");
    }
    return text;
  };
  BringUp record;
  record.driver = device.name;
  record.model = anonymous(device.model);
  record.firmware = anonymous(device.firmware);
  record.library = anonymous(device.library);
  if (!device.serial.empty()) {
    FieldHasher hasher;
    hasher.add("touchtrial bring-up");
    hasher.add(device.name);
    hasher.add(device.serial);
    record.device_mark = to_hex(hasher.finish()).substr(0, 4);
  }
  const auto note_known = [&](const char* name, double number) {
    if (number > 0.0) record.note(name, {number});
  };
  note_known("peak force", device.max_force_n);
  note_known("continuous force", device.continuous_force_n);
  note_known("max stiffness", device.max_stiffness_n_per_mm);
  // It counts only beside the stiffness.
  if (device.max_stiffness_n_per_mm > 0.0) note_known("max damping", device.max_damping_n_s_per_mm);
  note_known("max rate", device.max_rate_hz);
  if (device.workspace) note_extent(record, "workspace ", *device.workspace);
  record.outcome(BringUpStep::open) = StepOutcome::done;
  return record;
}

void note_extent(BringUp& record, const std::string& name, const Workspace& extent) {
  for (const DeviceAxis axis : kDeviceAxes) {
    const Vec3 along = direction_of(axis);
    record.note(name + std::string(name_of(axis)),
                {dot(extent.least_mm, along), dot(extent.greatest_mm, along)});
  }
}

}  // namespace touchtrial::device
