// The tables of a page, as HTML that is complete without its script.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "libreeb/base/value_range.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/defects/find_defects.h"

namespace reeb::tools {

// A caption is for people who do not see the page: what the table has in it.
using NamedText = std::pair<std::string, std::string>;
std::string summary_table(const std::string& caption, std::span<const NamedText> rows);

// A row has a button that shows the pair in the skeleton, if there is one.
std::string pairs_table(std::span<const ooc::PairRow> rows, const ValueRange& range, bool with_buttons);

// The first `closeups` rows have a button that shows the surface there.
std::string defects_table(const Defects& defects, std::size_t most, std::size_t closeups);

std::string levels_table(const ooc::ReebFile& file);

}  // namespace reeb::tools
