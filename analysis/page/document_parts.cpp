#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"
#include "core/version.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string state_words(const store::StudyState& state) {
  if (!state.unblinded) return state.closed ? "closed, still blind" : "collecting, blind";
  const std::string reason =
      state.unblinding_reason.empty() ? "" : " (" + state.unblinding_reason + ")";
  return (state.closed ? "closed and unblinded" : "open; an interim look") + reason;
}

/// A name that is not taken by a method before.
bool is_taken(const StudyReport& report, std::size_t method, const std::string& slug) {
  for (std::size_t i = 0; i < method; ++i) {
    if (slug_of(report.methods[i].method) == slug) return true;
  }
  return false;
}

}  // namespace

Provenance provenance_of(const store::StudyStore& store, const std::string& database) {
  return {database, std::string(program_version()), to_hex(store.commitment().seal),
          store.file_head(), store.state()};
}

Definitions evidence_header(const Provenance& provenance) {
  return {{{"state", state_words(provenance.state)},
           {"database", provenance.database},
           {"seal of the study", provenance.seal},
           {"head of the file's chain",
            fmt::format("{} (event {})", to_hex(provenance.head.hash), provenance.head.length)},
           {"program", "touchtrial " + provenance.program_version}}};
}

std::string method_slug(const StudyReport& report, std::size_t method) {
  const std::string slug = slug_of(report.methods[method].method);
  if (!slug.empty() && !is_taken(report, method, slug)) return slug;
  // Two hyphens are in no slug.
  return slug + "--" + std::to_string(method + 1);
}

void add_method_heading(const StudyReport& report, std::size_t method, Section& section) {
  if (report.methods.size() < 2) return;
  section.blocks.emplace_back(
      Subheading{section.id + "-of-" + method_slug(report, method), report.methods[method].method});
}

std::string method_prefix(const StudyReport& report, std::size_t method) {
  return report.methods.size() > 1 ? report.methods[method].method + ": " : "";
}

}  // namespace touchtrial::analysis
