// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, and the other signals that ask a program to end: work stops after its wave and is saved.
#pragma once

namespace obscura {

// From now on the first signal only asks to stop; a second one ends the program at once.
void catch_interrupts();
// Writing takes a moment; ended in its midst, it would leave temporary files.
void ignore_interrupts();
bool is_interrupted();

}  // namespace obscura
