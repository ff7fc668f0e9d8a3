// The head of an OpenEXR file: its size and its channels.

const MAGIC = 20000630;

/** { width, height, channels: [name, ...] }. @throws Error where it is none, in words */
export function readExrHead(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < 8 || view.getUint32(0, true) !== MAGIC) throw new Error('This is not an EXR file.');
  let at = 8;
  const text = () => {
    const start = at;
    while (at < view.byteLength && view.getUint8(at)) ++at;
    return new TextDecoder().decode(new Uint8Array(buffer, start, at++ - start));
  };
  const head = {};
  for (let name = text(); name; name = text()) {
    text();  // its type
    const size = view.getUint32(at, true);
    const start = at + 4;
    if (name === 'dataWindow') {
      const [left, top, right, bottom] = [0, 4, 8, 12].map((offset) => view.getInt32(start + offset, true));
      Object.assign(head, { width: right - left + 1, height: bottom - top + 1 });
    }
    if (name === 'channels') {
      head.channels = [];
      at = start;
      for (let channel = text(); channel; channel = text()) {
        head.channels.push(channel);
        at += 16;
      }
    }
    at = start + size;
    if (at >= view.byteLength) break;
  }
  if (!head.width || !head.channels) throw new Error('This EXR file says neither its size nor its channels.');
  return head;
}
