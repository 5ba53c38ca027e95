// SPDX-License-Identifier: Apache-2.0
// A program of the build: prints the source file that holds ALBEDO_TABLE. Integrating takes 30 ms, which each start would
// have to wait for.
#include "scene/albedo_table.h"

#include <cstdio>

namespace {

using obscura::AlbedoTable;
using obscura::AlbedoTerms;

constexpr double INTERVAL = 2;  // entries within 1e-4, on average within 2e-6
// Entries are this much smaller than the integrals, so that 1 - a stays positive also in the kernels' float
// arithmetic where nothing is lost (grazing incidence, Schlick).
constexpr double FLOAT_MARGIN = 1 - 0x1p-21;
constexpr double LAST = static_cast<double>(AlbedoTable::SIZE - 1);

void print_entry(double value) {
    std::printf("%af,", static_cast<double>(static_cast<float>(FLOAT_MARGIN * value)));
}

}  // namespace

int main() {
    std::printf("#include \"scene/albedo_table.h\"\nconst obscura::AlbedoTable obscura::ALBEDO_TABLE{{\n");
    for (size_t j = 0; j < AlbedoTable::SIZE; ++j) {
        for (size_t i = 0; i < AlbedoTable::SIZE; ++i) {
            const double mu = static_cast<double>(i) / LAST;
            const double root = static_cast<double>(j) / LAST;
            const AlbedoTerms terms =
                j == 0 ? obscura::schlick_albedo(mu) : obscura::integrate_albedo(mu, root * root, INTERVAL);
            print_entry(terms.a);
            print_entry(terms.b);
        }
        std::printf("\n");
    }
    std::printf("}};\n");
}
