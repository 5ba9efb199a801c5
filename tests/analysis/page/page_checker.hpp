/// \file Checks that a page is complete, needs no other file, and can be read by a screen reader.
#pragma once

#include <string>
#include <vector>

namespace touchtrial {

/// The faults of a page, one sentence each; empty: none that this checker knows.
///
/// Elements close in order; ids are unique, and every reference to one leads somewhere; no script,
/// no handler, no address outside the page; the language is named; there is one h1, and headings do
/// not skip a level; tables have a caption and headers with a scope, and as many cells in every
/// row; figures have a caption, and their pictures a description; parts that scroll can be reached
/// by keyboard.
[[nodiscard]] std::vector<std::string> faults_of_page(const std::string& html);

}  // namespace touchtrial
