// All later orders of the moments: weights of chunks of orders by the lowest moments at all altitudes and the ground's
// irradiance, each over its sum so far. Include moments_device.glsl before this, and later_orders.glsl.

// Where the lowest moment lies in a table; after the last altitude it is the ground's irradiance.
int lowest_at(int i, int s) {
  return i == push.grid.altitudes ? irradiance_at(i, s) : moment_at(i, s, 0);
}

// What chunk n, from 0 on, added to a value of the table.
Vec4 chunk(int n, int at) {
  int after = n + 1 < push.chunks ? earlier_table(n + 1) : sum_table();
  return READ(moments, after + at) - READ(moments, earlier_table(n) + at);
}

// Behind the tables: the vectors that are made orthogonal, the first of which in the end holds all later orders over
// the last chunk, and the weights of the chunks.
int vector_at(int n, int i, int s) {
  return earlier_table(push.chunks) + ((n * (push.grid.altitudes + 1) + i) * push.grid.suns + s) * GROUPS;
}
int weight_at(int n, int s) { return vector_at(MOST_CHUNKS, 0, s) + n * push.grid.suns * GROUPS; }

// All later orders of a lowest moment or an irradiance.
Vec4 later_orders(int s, int at, int g) {
  Vec4 sum = Vec4(0.0);
  for (int n = 1; n < push.chunks; ++n) sum = sum + chunk(n, at) * READ(moments, weight_at(n, s) + g);
  return max(sum, Vec4(0.0));
}
