// A capture's upload queue as state. Queues outlive the page that shows them, so sending goes on in the background.
import { useEffect, useState } from 'preact/hooks';
import { type Upload, UploadQueue } from './upload_queue';

const queues = new Map<string, UploadQueue>();

function queueOf(path: string): UploadQueue {
  let queue = queues.get(path);
  if (!queue) queues.set(path, (queue = new UploadQueue(path)));
  return queue;
}

export function useUploads(path: string): { queue: UploadQueue; uploads: readonly Upload[] } {
  const queue = queueOf(path);
  const [uploads, setUploads] = useState(queue.list);
  useEffect(() => {
    setUploads(queue.list);
    return queue.watch(() => setUploads(queue.list));
  }, [queue]);
  return { queue, uploads };
}
