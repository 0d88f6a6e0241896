// The pictures of one or several graphs that need no mesh, as SVG.
#pragma once

#include <span>
#include <string>

#include "ooc/reeb_file/reeb_file.h"
#include "tools/plot/chosen_level.h"

namespace reeb::tools {

// Here and below, `temp_folder` is for files of the programs that draw, and a graph with nothing to draw gives a
// picture that says so. THROWS: Error{kResource}: a program is missing or fails; Error{kBadInput}: the file does not
// have what is asked for.

// The number of loops above a persistence, a curve for each file.
std::string draw_loops(std::span<const ooc::ReebFile> files, const LevelChoice& choice, const std::string& temp_folder);

std::string draw_diagram(const ooc::ReebFile& file, const LevelChoice& choice, const std::string& temp_folder);

// Laid out by value: by dot up to kMostNodesOfDot nodes.
inline constexpr std::size_t kMostNodesOfDot = 400;
// Without a choice, a graph of more nodes is drawn at a level with at most these: a picture shows no more.
inline constexpr std::uint64_t kMostNodesUnasked = 100'000;
std::string draw_graph(const ooc::ReebFile& file, const LevelChoice& choice, const std::string& temp_folder);

// "35 nodes, 37 arcs, 3 loops".
std::string counts_text(const ReebGraph& graph);

}  // namespace reeb::tools
