"""Starting and stopping: the belt as a wave guide, fed by the steady result of the pipeline."""
