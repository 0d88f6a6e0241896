// Whether an input is of the kind that a command needs.
#pragma once

#include <string>

namespace reeb::tools {

// What outputs are named by default: scan.ply.gz -> scan, - -> mesh
std::string stem_of(const std::string& mesh);

// For `reeb COMMAND FILE`, where FILE must be a Reeb graph.
// THROWS: Error{kBadInput} that says what the file is instead, and what to do.
void require_reeb_file(const std::string& path, const std::string& command);

// The same where the name is that of a file. `hint_of_mesh`: for a mesh or an image; `hint`: for any other file.
void require_graph_file(const std::string& path, const std::string& hint_of_mesh, const std::string& hint);

// For a file that must be a fragment. THROWS: Error{kBadInput} if it is something else that we know.
void require_fragment(const std::string& path);

// For a file that must be a mesh. THROWS: Error{kBadInput} with this hint if it is a Reeb graph.
void require_mesh_file(const std::string& path, const std::string& hint);
// In addition, THROWS: Error{kUsage} for standard input.
void require_mesh_to_reread(const std::string& path, const std::string& hint);

}  // namespace reeb::tools
