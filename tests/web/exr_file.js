// The simplest EXR there is: scan lines of float, not compressed.

/** Bytes of a picture; `channels` maps names to a value or to `(column, row) => value`. */
export function exrFile(width, height, channels) {
  const names = Object.keys(channels).sort();
  const chunks = [];
  const bytes = (...values) => chunks.push(Buffer.from(values));
  const int = (value) => {
    const buffer = Buffer.alloc(4);
    buffer.writeInt32LE(value);
    chunks.push(buffer);
  };
  const float = (value) => {
    const buffer = Buffer.alloc(4);
    buffer.writeFloatLE(value);
    chunks.push(buffer);
  };
  const text = (value) => chunks.push(Buffer.from(`${value}\0`));
  const attribute = (name, type, size, write) => {
    text(name);
    text(type);
    int(size);
    write();
  };
  const window = () => [0, 0, width - 1, height - 1].forEach(int);
  int(20000630);
  int(2);
  attribute('channels', 'chlist', names.reduce((sum, name) => sum + name.length + 17, 1), () => {
    for (const name of names) {
      text(name);
      [2, 0, 1, 1].forEach(int);  // float, not perceptually linear, every pixel
    }
    bytes(0);
  });
  attribute('compression', 'compression', 1, () => bytes(0));
  attribute('dataWindow', 'box2i', 16, window);
  attribute('displayWindow', 'box2i', 16, window);
  attribute('lineOrder', 'lineOrder', 1, () => bytes(0));
  attribute('pixelAspectRatio', 'float', 4, () => float(1));
  attribute('screenWindowCenter', 'v2f', 8, () => [0, 0].forEach(float));
  attribute('screenWindowWidth', 'float', 4, () => float(1));
  bytes(0);
  const head = Buffer.concat(chunks);
  const line = 8 + 4 * width * names.length;
  const body = Buffer.alloc(height * (8 + line));
  for (let row = 0; row < height; ++row) {
    const start = head.length + 8 * height + row * line;
    body.writeBigUInt64LE(BigInt(start), 8 * row);
    let at = 8 * height + row * line;
    body.writeInt32LE(row, at);
    body.writeInt32LE(line - 8, at + 4);
    at += 8;
    for (const name of names) {
      for (let column = 0; column < width; ++column, at += 4) {
        const value = channels[name];
        body.writeFloatLE(typeof value === 'function' ? value(column, row) : value, at);
      }
    }
  }
  return Buffer.concat([head, body]);
}
