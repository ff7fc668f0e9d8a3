// What is said of the frame on screen: its speed, its method, its error.

import { h } from './dom.js';
import { words } from './editors.js';
import { format } from './numbers.js';

const REFRESH_MS = 250;

/**
 * Shows the facts of each frame in `element`, at most four times a second; `settings(method,
 * options)` are in words. Returns what shows them again, for when there are words for more.
 */
export function bindFacts(element, view, settings) {
  let { facts } = view;  // a frame may have come before
  let timer;
  const draw = () => {
    timer = undefined;
    if (facts) element.replaceChildren(...lines(facts, view.framesPerSecond, settings).map(
      ([name, value, title]) => h('span', { className: 'fact', title, 'data-fact': name },
                                  h('span', { className: 'quiet' }, `${name} `), value)));
  };
  view.addEventListener('frame', ({ detail }) => {
    facts = detail;
    timer ??= setTimeout(draw, element.childElementCount ? REFRESH_MS : 0);
  });
  draw();
  return draw;
}

function lines(facts, framesPerSecond, settings) {
  const speed = facts.moving || framesPerSecond > 4
    ? ['Frames', `${framesPerSecond}/s`, 'Frames that reached the screen in the last second']
    : ['Frame', `${format(Math.round(facts.totalMs))} ms`, 'From the request to the screen'];
  return [
    speed,
    ['Render', `${format(Number((facts.renderMs ?? 0).toPrecision(3)))} ms`, 'Time on the device'],
    ['Size', `${facts.width} × ${facts.height}`, 'Pixels of this frame'],
    ['Method', words(facts.method ?? '?'), 'How the light of this frame was computed'],
    ['Options', settings(facts.method, facts.options), 'Of the method, but for its defaults'],
    ['Error', errorText(facts), 'A bound meant to hold in 95 % of frames'],
    ['Exposure', `${signed(facts.exposure)} EV`, 'Stops; at 0 a white card facing the sun outside the air is 1'],
  ].filter(([, value]) => value !== '');
}

function errorText({ error, met }) {
  const value = Number(error);
  if (!error || !Number.isFinite(value)) return error ?? '?';
  const text = `≤ ${format(Number((100 * value).toPrecision(2)))} %`;
  return met === 'false' ? `${text}, the best there is` : text;
}

function signed(text) {
  const value = Number(text);
  if (!text || !Number.isFinite(value)) return '?';
  return `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`;
}
