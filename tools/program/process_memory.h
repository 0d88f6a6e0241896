// How the memory of a process that is all ours is allocated. For the programs only: the library leaves the
// processes of others as they are.
#pragma once

namespace reeb::tools {

// Call it first in main(). Large blocks then return to the system as soon as they are freed, so resident memory is what
// the budget counts, not what was needed at some earlier time. A program that calls it is linked with an operator new
// that asks for huge pages in blocks of 4 MiB and more: such a block is the table of a graph, all of which is used
// soon, and its pages come 512 at a time.
void set_up_process_memory();

}  // namespace reeb::tools
