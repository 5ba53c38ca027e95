// SPDX-License-Identifier: Apache-2.0
// The header of a reference picture, and whether another one may go on with it.
#pragma once

#include "reference/reference_render.h"
#include "scene/radiometry.h"

namespace obscura::reference {

struct ReferenceFacts {
    Radiometry radiometry;
    double d_max;  // m; without meaning for path tracing
};

// settings: with the sky resolved. Throws InputError where the obscurances' ambient light would be infinite.
ReferenceFacts find_facts(const ReferenceJob& job, const RenderSettings& settings);

// Everything that shapes the picture, but not how far it is.
void describe_reference(const ReferenceJob& job, const RenderSettings& settings, const ReferenceFacts& facts,
                        Image& image);

// How far it is. previous: the picture it went on with, or null.
void describe_progress(uint64_t passes, uint64_t finished_sets, ReferenceResult& result,
                       const Image* previous);

// The passes of the previous picture, made in the same way as this one whose pixels are still to come. Throws InputError
// that names the file and the option that differs.
uint64_t passes_to_continue(const Image& previous, std::string_view file, const Image& image);

}  // namespace obscura::reference
