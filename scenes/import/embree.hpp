// Hair and fur of Embree's tutorials: an XML file, and beside it NAME.bin or NAME.bin.gz with the numbers.
//
// Read are its RoundLineSegments: u32 index[], and float4 (x, y, z, radius) points[]. Segment i goes from point index[i] to the
// next one, with radii in between. Segments that follow each other are a strand. Whatever else the XML holds is named once in a
// warning and left out.
#pragma once

#include <functional>

#include "scenes/import/bytes.hpp"
#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

// `numbers` gives the contents of the .bin file when they are needed.
Scene read_embree(const View& xml, const std::function<Bytes()>& numbers, const StrandOptions& options = {});

// A Reader: NAME.xml with NAME.bin or NAME.bin.gz beside it.
Imported import_embree(const std::string& path, const ImportOptions& options);

}  // namespace myriad::scenes::importing
