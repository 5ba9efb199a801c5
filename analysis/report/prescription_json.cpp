/// \file Reads the prescription from a study's public configuration.
#include "analysis/outcomes/collection.hpp"
#include "core/errors.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "study/random_orders.hpp"
#include "study/session_plan.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using nlohmann::json;

void read_session(const json& session, Prescription& prescription) {
  prescription.sight = session.at("sight").get<std::string>();
  prescription.masking_wanted = session.at("masking").at("wanted").get<bool>();
  prescription.masking_dbfs = session.at("masking").at("level_dbfs").get<double>();
  prescription.draft = study::draft_notice(session.value("language", "en"));
}

/// The number of orders of methods; 1 unless several methods are presented in separate blocks.
int method_orders_of(const json& configuration) {
  const study::Protocol* protocol = study::find_protocol(configuration.value("protocol", ""));
  const bool has_several_methods = protocol != nullptr && protocol->all_methods;
  const json trials = configuration.at("trials");
  if (!has_several_methods || configuration.contains("intervals") ||
      trials.value("blocks", "by-method") != "by-method")
    return 1;
  return study::williams_rows(static_cast<int>(configuration.at("methods").size()));
}

study::ValidityRule validity_rule_of(const json& rule) {
  return {.min_exploring_s = rule.at("exploring_s").get<double>(),
          .min_contact_s = rule.at("contact_s").get<double>(),
          .min_path_mm = rule.at("path_mm").get<double>(),
          .min_median_n = rule.at("least_median_n").get<double>(),
          .max_median_n = rule.at("largest_median_n").get<double>(),
          .saturated_share = rule.at("saturated_share").get<double>()};
}

Prescription prescription_of(const json& configuration) {
  const study::MaskingPlan default_masking;
  Prescription prescription;
  prescription.sight = "curtain";
  prescription.masking_wanted = default_masking.wanted;
  prescription.masking_dbfs = default_masking.level_dbfs;
  const json& trials = configuration.at("trials");
  prescription.explore_limit_s = trials.at("explore_limit_s").get<double>();
  prescription.on_timeout = trials.at("on_timeout").get<std::string>();
  prescription.order = trials.at("order").get<std::string>();
  prescription.repeats = trials.at("repeats").get<int>();
  prescription.intervals = configuration.value("intervals", 0);
  const study::Protocol* protocol = study::find_protocol(configuration.value("protocol", ""));
  prescription.adaptive = protocol != nullptr && protocol->adaptive;
  if (prescription.adaptive) prescription.order = "by the procedure";
  prescription.method_orders = method_orders_of(configuration);
  if (trials.contains("validity")) prescription.validity = validity_rule_of(trials["validity"]);
  if (configuration.contains("session")) read_session(configuration["session"], prescription);
  if (configuration.contains("visits")) {
    prescription.visits = configuration["visits"].at("count").get<int>();
    prescription.visits_needed = configuration["visits"].at("needed").get<int>();
    prescription.min_days = configuration["visits"].value("least_days", 0.0);
    if (const json max_days = configuration["visits"].value("most_days", json());
        max_days.is_number()) {
      prescription.max_days = max_days.get<double>();
    }
  }
  if (configuration.contains("groups")) {
    configuration["groups"].at("labels").get_to(prescription.groups);
  }
  return prescription;
}

}  // namespace

Prescription prescription_from_json(const std::string& configuration) {
  try {
    return prescription_of(json::parse(configuration));
  } catch (const json::exception&) {
    throw StoreError(
        "the study's configuration in the database is not readable; run `touchtrial verify`, and "
        "restore a backup if it fails");
  }
}

}  // namespace touchtrial::analysis
