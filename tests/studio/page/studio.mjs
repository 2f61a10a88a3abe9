// Starts glint-studio on a folder and ends it again.
import { spawn } from 'node:child_process';
import path from 'node:path';

export async function startStudio(programs, folder, port = 0) {
  const child = spawn(path.join(programs, 'glint-studio'), ['--no-browser', '--port', String(port), folder], { stdio: ['ignore', 'pipe', 'pipe'] });
  process.on('exit', () => child.kill());
  let said = '';
  child.stderr.on('data', (bytes) => (said += bytes));
  const address = await new Promise((done, fail) => {
    let text = '';
    child.stdout.on('data', (bytes) => {
      text += bytes;
      const found = /http:\/\/127\.0\.0\.1:\d+\/\S*/.exec(text);
      if (found) done(found[0]);
    });
    child.on('exit', (code) => fail(new Error(`glint-studio ended with ${code}: ${said}`)));
  });
  const ended = (signal) => new Promise((done) => {
    child.on('exit', done);
    child.kill(signal);
  });
  return {
    address,
    home: new URL(address).origin,
    pid: child.pid,
    said: () => said,
    end: () => ended('SIGTERM'),
    kill: () => ended('SIGKILL'),
  };
}
