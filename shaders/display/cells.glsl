// Pixels between rays that were traced: a square cell is filled from its corners, linearly along both sides. An
// invocation has AT_ONCE neighbouring columns of a cell, and all its rows.
layout(local_size_x = 64) in;
layout(constant_id = 0) const int AT_ONCE = 1;   // 4 where rows are whole fours, which are stored as one; or 1

layout(binding = 0, r32ui) uniform readonly uimageBuffer cells;  // the first pixel of each

layout(push_constant) uniform Push {
  int side;   // of the cells, pixels
  int width;
  int panel;  // rows after which neighbours are neighbours no more
  int first;
  int end;
} push;

struct Chunk {
  bool none;
  int corners[4];   // pixels
  vec4 across;      // of the columns, shares of the way between the corners
  float a_row;      // the same of a row
  int first;        // pixel
  int rows;
};

Chunk chunk_of(int i) {
  int chunks = push.side / AT_ONCE;
  int corner = int(imageLoad(cells, i / chunks).x);
  int column = corner % push.width;
  int row = corner / push.width;
  int last_row = (row / push.panel + 1) * push.panel - 1;
  int right = min(column + push.side, push.width - 1);
  int below = min(row + push.side, last_row);
  Chunk chunk;
  int from = i % chunks * AT_ONCE;
  chunk.none = column + from >= push.width;
  chunk.corners[0] = corner;
  chunk.corners[1] = corner + right - column;
  chunk.corners[2] = corner + (below - row) * push.width;
  chunk.corners[3] = chunk.corners[2] + right - column;
  chunk.across = (float(from) + vec4(0.0, 1.0, 2.0, 3.0)) / float(max(right - column, 1));
  chunk.a_row = 1.0 / float(max(below - row, 1));
  chunk.first = corner + from;
  chunk.rows = min(push.side, last_row + 1 - row);
  return chunk;
}

// A plane's values along the chunk's first row, and along that of the lower corners.
struct Ends {
  vec4 upper;
  vec4 lower;
};

Ends ends_of(Chunk chunk, vec4 at_corners) {
  Ends ends;
  ends.upper = at_corners.x + (at_corners.y - at_corners.x) * chunk.across;
  ends.lower = at_corners.z + (at_corners.w - at_corners.z) * chunk.across;
  return ends;
}

#define AT_CORNERS(plane, chunk)                                                              \
  vec4(imageLoad(plane, chunk.corners[0]).x, imageLoad(plane, chunk.corners[1]).x,            \
       imageLoad(plane, chunk.corners[2]).x, imageLoad(plane, chunk.corners[3]).x)
