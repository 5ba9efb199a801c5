#include "measure_tables.hpp"

#include "core/errors.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/rating/analysis/measures.hpp"
#include "protocols/threshold/analysis/measures.hpp"
#include "study/study.hpp"

#include <string_view>
#include <vector>

namespace touchtrial {
namespace {

constexpr std::string_view kThresholdStudy = R"({
  "study": "example", "protocol": "threshold", "rendering": {"reference_grey": 128},
  "classes": [{"label": "bark", "images": ["bark.png"]}], "methods": [{"name": "adaptive"}],
  "threshold": {"task": "detection", "levels": {"from": -40, "to": 0, "step": 1}}
})";

std::vector<analysis::ListedObject> objects_of(const std::string& studies) {
  if (studies == "identification") return analysis::identification::listed_objects();
  if (studies == "ratings") return analysis::rating::listed_objects();
  if (studies != "thresholds") throw UsageError("no measures are those of " + studies);
  analysis::threshold::ThresholdReport report;
  report.design = study::parse_study(std::string(kThresholdStudy), "", "example");
  return analysis::threshold::listed_objects(report);
}

}  // namespace

std::string table_of_measures(const std::string& studies) {
  std::string text = "| in | member | meaning |\n| --- | --- | --- |\n";
  for (const analysis::ListedObject& object : objects_of(studies)) {
    text += "| `" + object.place + "` | | |\n";
    for (const auto& [name, meaning] : object.members) {
      text += "| | `" + name + "` | " + meaning + " |\n";
    }
  }
  return text;
}

}  // namespace touchtrial
