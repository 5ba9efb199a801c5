#include "analysis/planning/uncertain_subject.hpp"

#include "analysis/planning/fit_report.hpp"
#include "analysis/planning/power_runs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"

#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestFit = std::uintmax_t{1} << 26U;
constexpr std::size_t kMostDraws = 100'000;

[[noreturn]] void refuse_fit(const std::string& file) {
  throw FileError(one_line(file +
                           ": is not what `touchtrial fit DB --json` prints, or is truncated; "
                           "print it anew"));
}

/// Parses without going deeper than a fit is: what is done with values goes down with them.
Json parsed_fit(std::string_view text, const std::string& file) {
  constexpr int kDeepest = 24;
  return Json::parse(text, [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) refuse_fit(file);
    return true;
  });
}

/// A draw's subject: the fitted one, but for the draw's own keys.
simulation::SubjectModel drawn_subject(Json fitted, const Json& draw, const std::string& source) {
  for (const std::string_view key : kDrawnKeys) fitted[std::string(key)] = draw.at(key);
  return simulation::parse_subject_model(fitted.dump(), source);
}

UncertainSubject uncertain_subject_of(const Json& fit, const std::string& file) {
  const Json& fitted = fit.at("fitted");
  device::DeviceModel device;
  if (const Json& model = fit.at("device"); !model.is_null()) {
    device = device::parse_device_model(model.dump(), file + ": /device");
  }
  UncertainSubject uncertain;
  uncertain.subject = simulation::parse_subject_model(fitted.dump(), file + ": /fitted");
  uncertain.subject.device = device;
  // Missing keys have defaults in a subject file, but no fit lacks one.
  const Json whole = Json::parse(simulation::subject_model_json(uncertain.subject));
  for (const auto& [key, value] : whole.items()) {
    if (!fitted.contains(key)) refuse_fit(file);
  }
  const Json& draws = fit.at("draws");
  if (!draws.is_array() || draws.size() > kMostDraws) refuse_fit(file);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    uncertain.draws.push_back(
        drawn_subject(fitted, draws[i], fmt::format("{}: /draws/{}", file, i)));
    uncertain.draws.back().device = device;
  }
  return uncertain;
}

}  // namespace

UncertainSubject load_uncertain_subject(const std::filesystem::path& file) {
  const Bytes content = read_file(file, kLargestFit);
  const std::string name = one_line(file.string());
  UncertainSubject uncertain;
  try {
    const Json fit = parsed_fit(text_of(content), name);
    if (fit.is_object() && fit.contains("accuracies")) {
      throw FileError(name +
                      ": has no draws, because published accuracies have none; fit a "
                      "study's answers");
    }
    uncertain = uncertain_subject_of(fit, name);
  } catch (const Json::exception&) {
    refuse_fit(name);
  }
  if (uncertain.draws.empty()) {
    throw FileError(name +
                    ": has no draws, as a fit with --bootstraps 0; fit again with --bootstraps "
                    "499");
  }
  return uncertain;
}

std::string words_of(const UncertainSubject& uncertain) {
  constexpr std::size_t kShown = 12;
  FieldHasher hasher;
  for (const simulation::SubjectModel& draw : uncertain.draws) {
    hasher.add(simulation::subject_model_json(draw));
  }
  return fmt::format("{}; each study with one of {} draws of its fit, all of them {}",
                     words_of(uncertain.subject), uncertain.draws.size(),
                     to_hex(hasher.finish()).substr(0, kShown));
}

}  // namespace touchtrial::planning
